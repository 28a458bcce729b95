// SPDX-License-Identifier: MIT
#include "capture/pose/trajectory.h"

#include "capture/files/text_file.h"
#include "capture/pose/rolling_shutter.h"
#include "core/diagnostics/error.h"
#include "core/files/write_file.h"
#include "core/text/number.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <string_view>

namespace sheen::capture {
namespace {

constexpr std::size_t kMaxTrajectoryBytes = std::size_t{256} << 20;
constexpr double kMaxDistanceM = 1e6;  // beyond it single precision has nothing left to say
constexpr const char* kTrajectoryRemedy = "write lines of the form `stamp tx ty tz qx qy qz qw`";

bool is_integer(double stamp) {
  return stamp == std::floor(stamp);
}

[[noreturn]] void fail(const std::filesystem::path& path, int line, const std::string& fault) {
  throw core::bad_input(path, "line " + std::to_string(line) + " " + fault, kTrajectoryRemedy);
}

std::vector<std::string_view> words_of(std::string_view text) {
  constexpr std::string_view blanks = " \t";
  std::vector<std::string_view> words;
  while (true) {
    text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
    if (text.empty()) return words;
    words.push_back(text.substr(0, text.find_first_of(blanks)));
    text.remove_prefix(words.back().size());
  }
}

/// What a line of another form is, as far as it is known; empty for one of no known form.
std::string known_form(std::string_view text, const std::vector<std::string_view>& words) {
  const auto commas = std::count(text.begin(), text.end(), ',');
  if (words.size() == 8 && !core::parse_number(words[0]) &&
      std::all_of(words.begin() + 1, words.end(),
                  [](std::string_view word) { return core::parse_number(word).has_value(); })) {
    return "begins with a name, " + core::quotable(words[0]) +
           ", where its stamp should be: write the number of the image, counted from 0";
  }
  const bool is_heading = std::any_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z' && c != 'e' && c != 'd') || c == '_';
  });
  if (is_heading && words.size() > 1 && !core::parse_number(words[0])) {
    return "is a heading; begin it with #";
  }
  if (words.size() >= 8 && core::has_decimal_comma(words[1])) {
    return "has decimal commas; write points";
  }
  if (commas >= 7) return "separates by commas; separate by blanks, in the order of TUM";
  if (std::count(text.begin(), text.end(), ';') >= 7) {
    return "separates by semicolons; separate by blanks, in the order of TUM";
  }
  if (words.size() == 12) return "holds twelve numbers, a matrix as KITTI writes it";
  if (words.size() == 16) return "holds sixteen numbers, a matrix";
  if (words.size() == 7) return "holds seven numbers: the stamp is missing";
  return {};
}

/// Exactly eight numbers.
std::array<double, 8> numbers_of(const std::filesystem::path& path, int line, std::string_view text,
                                 const std::vector<std::string_view>& words) {
  const auto refuse = [&](const std::string& why) {
    const std::string form = known_form(text, words);
    fail(path, line, "does not hold eight numbers: it " + (form.empty() ? why : form));
  };
  std::array<double, 8> numbers{};
  if (words.size() != 8) refuse("holds " + std::to_string(words.size()) + " words");
  for (std::size_t i = 0; i < 8; ++i) {
    const auto number = core::parse_number(words[i]);
    if (!number) refuse("says " + core::why_no_number(words[i]));
    numbers[i] = number.value_or(0);
  }
  return numbers;
}

/// `is_whole` is cleared by a stamp that is written with a decimal point or an exponent.
Trajectory::Entry parse_line(const std::filesystem::path& path, int line, std::string_view text,
                             bool& is_whole) {
  const std::vector<std::string_view> words = words_of(text);
  const std::array<double, 8> n = numbers_of(path, line, text, words);
  is_whole = is_whole && words[0].find_first_not_of("+-0123456789") == std::string_view::npos;
  if (!std::all_of(n.begin(), n.end(), [](double v) { return std::isfinite(v); })) {
    fail(path, line, "holds a number that is not finite");
  }
  const Eigen::Vector3d position(n[1], n[2], n[3]);
  if (!(position.cwiseAbs().maxCoeff() < kMaxDistanceM)) fail(path, line, "lies too far away");
  const Eigen::Quaterniond rotation(n[7], n[4], n[5], n[6]);
  // Files carry few digits; anything far from length one is something else than a rotation.
  if (!(std::abs(rotation.norm() - 1) < 0.05)) {
    fail(path, line,
         rotation.norm() == 0 ? "holds a quaternion of zeros, as a lost pose has: leave it out"
                              : "holds no unit quaternion");
  }
  Trajectory::Entry entry{n[0], Eigen::Isometry3d::Identity()};
  entry.board_from_camera.linear() = rotation.normalized().toRotationMatrix();
  entry.board_from_camera.translation() = position;
  return entry;
}

}  // namespace

Trajectory::Trajectory(std::vector<Entry> entries, std::optional<Stamps> stamps)
    : entries_(std::move(entries)) {
  std::sort(entries_.begin(), entries_.end(),
            [](const Entry& a, const Entry& b) { return a.stamp < b.stamp; });
  const bool are_whole = std::all_of(entries_.begin(), entries_.end(),
                                     [](const Entry& e) { return is_integer(e.stamp); });
  stamps_ = stamps.value_or(are_whole ? Stamps::indices : Stamps::seconds);
}

std::optional<Eigen::Isometry3d> Trajectory::board_from_camera(const Frame& frame,
                                                               double fps) const {
  const Place place = place_of(frame, fps);
  if (place == entries_.end()) return std::nullopt;
  return place->board_from_camera;
}

std::optional<Twist> Trajectory::velocity(const Frame& frame, double fps) const {
  constexpr double longest_s = 0.25;
  const Place place = place_of(frame, fps);
  if (place == entries_.end()) return std::nullopt;
  const Place before = place == entries_.begin() ? place : std::prev(place);
  const Place after = std::next(place) == entries_.end() ? place : std::next(place);
  const double time_s = (after->stamp - before->stamp) / (stamps_ == Stamps::indices ? fps : 1);
  if (!(time_s > 0) || time_s > longest_s) return std::nullopt;
  return twist_between(before->board_from_camera.inverse(), after->board_from_camera.inverse()) /
         time_s;
}

Trajectory::Place Trajectory::place_of(const Frame& frame, double fps) const {
  assert(fps > 0);
  if (entries_.empty()) return entries_.end();
  const bool are_indices = stamps_ == Stamps::indices;
  const double wanted = are_indices ? frame.index : frame.time_s;
  // A millionth of a second more: stamps are written with six digits.
  const double spacing_s = frame.spacing_s > 0 ? frame.spacing_s : 1 / fps;
  const double tolerance = are_indices ? 0 : 0.5 * spacing_s + 1e-6;

  // Look at the entries on both sides of the wanted stamp.
  auto nearest = std::lower_bound(entries_.begin(), entries_.end(), wanted,
                                  [](const Entry& e, double stamp) { return e.stamp < stamp; });
  if (nearest == entries_.end()) --nearest;
  if (nearest != entries_.begin()) {
    const auto before = std::prev(nearest);
    if (std::abs(before->stamp - wanted) < std::abs(nearest->stamp - wanted)) nearest = before;
  }
  return std::abs(nearest->stamp - wanted) <= tolerance ? nearest : entries_.end();
}

Trajectory read_trajectory(const std::filesystem::path& path) {
  std::istringstream in(read_text_file(path, kMaxTrajectoryBytes));
  std::vector<Trajectory::Entry> entries;
  std::string text;
  bool is_whole = true;
  for (int line = 1; std::getline(in, text); ++line) {
    const std::size_t first = text.find_first_not_of(" \t");
    if (first == std::string::npos || text[first] == '#') continue;
    entries.push_back(parse_line(path, line, text, is_whole));
  }
  if (entries.empty()) throw core::bad_input(path, "holds no pose", kTrajectoryRemedy);

  Trajectory trajectory(std::move(entries), is_whole ? Stamps::indices : Stamps::seconds);
  const auto& sorted = trajectory.entries();
  const auto twice =
      std::adjacent_find(sorted.begin(), sorted.end(),
                         [](const auto& a, const auto& b) { return a.stamp == b.stamp; });
  if (twice != sorted.end()) {
    std::ostringstream fault;
    fault.precision(18);
    fault << "has two poses with the stamp " << twice->stamp;
    throw core::bad_input(path, fault.str(), "keep one line per frame");
  }
  return trajectory;
}

void write_trajectory(const std::filesystem::path& path,
                      const std::vector<Trajectory::Entry>& entries) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out << "# stamp tx ty tz qx qy qz qw (board_from_camera, metres)\n" << std::setprecision(12);
  for (const Trajectory::Entry& entry : entries) {
    const Eigen::Vector3d t = entry.board_from_camera.translation();
    const Eigen::Quaterniond q(entry.board_from_camera.linear());
    out << entry.stamp << ' ' << t.x() << ' ' << t.y() << ' ' << t.z() << ' ' << q.x() << ' '
        << q.y() << ' ' << q.z() << ' ' << q.w() << '\n';
  }
  core::write_file(path, out.str());
}

}  // namespace sheen::capture
