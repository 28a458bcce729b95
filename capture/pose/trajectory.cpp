// SPDX-License-Identifier: MIT
#include "capture/pose/trajectory.h"

#include "capture/files/text_file.h"
#include "core/diagnostics/error.h"
#include "core/files/write_file.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
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

/// Exactly eight numbers, whatever the locale.
bool parse_numbers(std::string_view text, std::array<double, 8>& numbers) {
  constexpr std::string_view blanks = " \t\r";
  for (double& number : numbers) {
    text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
    if (text.starts_with('+')) text.remove_prefix(1);
    const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (status != std::errc()) return false;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (!text.empty() && blanks.find(text.front()) == std::string_view::npos) return false;
  }
  return text.find_first_not_of(blanks) == std::string_view::npos;
}

Trajectory::Entry parse_line(const std::filesystem::path& path, int line, std::string_view text) {
  std::array<double, 8> n{};
  if (!parse_numbers(text, n)) fail(path, line, "does not hold eight numbers");
  if (!std::all_of(n.begin(), n.end(), [](double v) { return std::isfinite(v); })) {
    fail(path, line, "holds a number that is not finite");
  }
  const Eigen::Vector3d position(n[1], n[2], n[3]);
  if (!(position.cwiseAbs().maxCoeff() < kMaxDistanceM)) fail(path, line, "lies too far away");
  const Eigen::Quaterniond rotation(n[7], n[4], n[5], n[6]);
  // Files carry few digits; anything far from length one is something else than a rotation.
  if (!(std::abs(rotation.norm() - 1) < 0.05)) fail(path, line, "holds no unit quaternion");
  Trajectory::Entry entry{n[0], Eigen::Isometry3d::Identity()};
  entry.board_from_camera.linear() = rotation.normalized().toRotationMatrix();
  entry.board_from_camera.translation() = position;
  return entry;
}

}  // namespace

Trajectory::Trajectory(std::vector<Entry> entries) : entries_(std::move(entries)) {
  std::sort(entries_.begin(), entries_.end(),
            [](const Entry& a, const Entry& b) { return a.stamp < b.stamp; });
  stamps_are_indices_ = std::all_of(entries_.begin(), entries_.end(),
                                    [](const Entry& e) { return is_integer(e.stamp); });
}

std::optional<Eigen::Isometry3d> Trajectory::board_from_camera(const Frame& frame,
                                                               double fps) const {
  assert(fps > 0);
  if (entries_.empty()) return std::nullopt;
  const double wanted = stamps_are_indices_ ? frame.index : frame.time_s;
  const double tolerance = stamps_are_indices_ ? 0 : 0.5 / fps;

  // Look at the entries on both sides of the wanted stamp.
  auto nearest = std::lower_bound(entries_.begin(), entries_.end(), wanted,
                                  [](const Entry& e, double stamp) { return e.stamp < stamp; });
  if (nearest == entries_.end()) --nearest;
  if (nearest != entries_.begin()) {
    const auto before = std::prev(nearest);
    if (std::abs(before->stamp - wanted) < std::abs(nearest->stamp - wanted)) nearest = before;
  }
  if (!(std::abs(nearest->stamp - wanted) <= tolerance)) return std::nullopt;
  return nearest->board_from_camera;
}

Trajectory read_trajectory(const std::filesystem::path& path) {
  std::istringstream in(read_text_file(path, kMaxTrajectoryBytes));
  std::vector<Trajectory::Entry> entries;
  std::string text;
  for (int line = 1; std::getline(in, text); ++line) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    if (first == std::string::npos || text[first] == '#') continue;
    entries.push_back(parse_line(path, line, text));
  }
  if (entries.empty()) throw core::bad_input(path, "holds no pose", kTrajectoryRemedy);

  Trajectory trajectory(std::move(entries));
  const auto& sorted = trajectory.entries();
  const auto twice =
      std::adjacent_find(sorted.begin(), sorted.end(),
                         [](const auto& a, const auto& b) { return a.stamp == b.stamp; });
  if (twice != sorted.end()) {
    std::ostringstream fault;
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
