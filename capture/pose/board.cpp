// SPDX-License-Identifier: MIT
#include "capture/pose/board.h"

#include "capture/files/text_file.h"
#include "capture/pose/tag_family.h"
#include "core/diagnostics/error.h"
#include "core/files/write_file.h"
#include "core/text/nesting.h"
#include "core/text/number.h"

#include <yaml-cpp/yaml.h>

#include <cmath>
#include <iomanip>
#include <limits>
#include <locale>
#include <sstream>

namespace sheen::capture {
namespace {

constexpr std::size_t kMaxBoardBytes = std::size_t{4} << 20;
constexpr double kMaxExtentM = 1e3;
constexpr const char* kRemedy = "see docs/session-format.md for the two layouts of board.yaml";

/// board.yaml with errors that name the file.
class BoardReader {
 public:
  explicit BoardReader(const std::filesystem::path& path) : path_(path) {
    const std::string text = read_text_file(path, kMaxBoardBytes);
    if (core::bracket_depth(text) > core::kMostNesting) fail("nests its brackets too deep");
    root_ = YAML::Load(text);
  }

  [[noreturn]] void fail(const std::string& fault) const {
    throw core::bad_input(path_, fault, kRemedy);
  }

  [[nodiscard]] const YAML::Node& root() const { return root_; }

  /// A finite number within what a board can hold, or `fallback` where the key is missing.
  [[nodiscard]] double number(const YAML::Node& node, const char* key,
                              std::optional<double> fallback = std::nullopt) const {
    const YAML::Node value = node[key];
    if (!value && fallback) return *fallback;
    if (!value) fail(std::string(key) + " is missing");
    if (!value.IsScalar()) fail(std::string(key) + " is no usable number");
    const std::string& word = value.Scalar();
    // YAML writes nan and inf with a point before them.
    const auto result = core::parse_number(word.starts_with('.') ? "0" + word : word);
    if (!result || !(std::abs(*result) <= kMaxExtentM)) {
      fail(std::string(key) + " is no usable number: " +
           (result ? core::quotable(word) + " is too large" : core::why_no_number(word)));
    }
    return *result;
  }

  [[nodiscard]] int whole_number(const YAML::Node& node, const char* key, int least,
                                 std::optional<int> fallback = std::nullopt) const {
    const YAML::Node value = node[key];
    if (!value && fallback) return *fallback;
    // In decimal, whatever the leading zeros: YAML would read 010 as 8.
    const auto result =
        value && value.IsScalar() ? core::parse_whole_number(value.Scalar()) : std::nullopt;
    if (!result || *result < least || *result > std::numeric_limits<int>::max()) {
      fail(std::string(key) + " is missing or not a whole number from " + std::to_string(least));
    }
    return static_cast<int>(*result);
  }

  [[nodiscard]] double size(const YAML::Node& node, const char* key) const {
    const double value = number(node, key);
    if (!(value > 0)) fail(std::string(key) + " is not positive");
    return value;
  }

  [[nodiscard]] std::string text(const char* key, const std::string& fallback) const {
    const YAML::Node value = root_[key];
    if (!value) return fallback;
    if (!value.IsScalar()) fail(std::string(key) + " is no text");
    return value.Scalar();
  }

  /// Within braces a decimal comma splits a number: what follows it stands alone.
  void check_for_decimal_commas(const YAML::Node& entry) const {
    for (const auto& member : entry) {
      if (!member.first.IsScalar() || !member.second.IsNull()) continue;
      if (core::parse_whole_number(member.first.Scalar())) {
        fail("has numbers with decimal commas, such as before " +
             core::quotable(member.first.Scalar()) + "; write points");
      }
    }
  }

  void add(Board& board, int id, const Board::Tag& tag) const {
    if (!board.tags.emplace(id, tag).second) {
      fail("tag " + std::to_string(id) + " occurs twice");
    }
  }

 private:
  std::filesystem::path path_;
  YAML::Node root_;
};

TagFamily known_family(const BoardReader& reader, const Board& board) {
  const auto family = find_tag_family(board.family, board.border_bits);
  if (!family) {
    reader.fail("tag_family: no detector knows the family \"" + core::quotable(board.family) +
                "\" with a border of " + std::to_string(board.border_bits) + " bits");
  }
  return *family;
}

Board::Tag read_tag(const BoardReader& reader, const YAML::Node& node) {
  Board::Tag tag;
  tag.size_m = reader.size(node, "size");
  tag.board_from_tag.translation() = Eigen::Vector3d(
      reader.number(node, "x", 0), reader.number(node, "y", 0), reader.number(node, "z", 0));
  const Eigen::Quaterniond rotation(reader.number(node, "qw", 1), reader.number(node, "qx", 0),
                                    reader.number(node, "qy", 0), reader.number(node, "qz", 0));
  if (!(std::abs(rotation.norm() - 1) < 0.05)) reader.fail("a tag's quaternion has no unit length");
  tag.board_from_tag.linear() = rotation.normalized().toRotationMatrix();
  return tag;
}

/// ROS 2 writes 36h11 and Standard41h12 for what the library calls tag36h11 and tagStandard41h12.
std::string usual_name(const std::string& family) {
  if (find_tag_family(family, 1) || family.starts_with("DICT_")) return family;
  std::string name = family;
  if (name.size() > 3 && (name.starts_with("TAG") || name.starts_with("Tag"))) {
    name.replace(0, 3, "tag");
  } else if (!name.starts_with("tag")) {
    name.insert(0, "tag");
  }
  return find_tag_family(name, 1) ? name : family;
}

/// Refuses files that say something about tags or boards, but not where tags lie.
[[noreturn]] void refuse_other_form(const BoardReader& reader) {
  const std::string target = reader.text("target_type", "");
  if (!target.empty()) {
    reader.fail("target_type is " + core::quotable(target) +
                ", a board without tags: poses need tags (target_type: 'aprilgrid')");
  }
  if (reader.root()["standalone_tags"]) {
    reader.fail(
        "has standalone_tags only: tag_bundles is missing, which says where tags lie "
        "against each other");
  }
  for (const auto& member : reader.root()) {
    if (member.second.IsMap() && member.second["ros__parameters"]) {
      reader.fail(
          "is a file of ROS 2's apriltag_ros, which does not say where tags lie against "
          "each other: tag_bundles is missing");
    }
  }
  reader.fail("has neither tag_bundles nor target_type: 'aprilgrid'");
}

/// apriltag_ros: every bundle is a list of tags in the common board frame.
Board read_bundles(const BoardReader& reader) {
  Board board;
  board.family = usual_name(reader.text("tag_family", "tag36h11"));
  board.border_bits = reader.whole_number(reader.root(), "border_bits", 1, 1);
  const int codes = code_count(known_family(reader, board));
  const YAML::Node bundles = reader.root()["tag_bundles"];
  if (!bundles.IsSequence()) reader.fail("tag_bundles is no list");
  for (const YAML::Node& bundle : bundles) {
    const YAML::Node layout = bundle.IsMap() ? bundle["layout"] : YAML::Node();
    if (!layout.IsSequence()) reader.fail("a bundle has no layout");
    for (const YAML::Node& entry : layout) {
      if (!entry.IsMap()) reader.fail("a layout holds something that is no tag");
      reader.check_for_decimal_commas(entry);
      const int id = reader.whole_number(entry, "id", 0);
      if (id >= codes) {
        reader.fail("tag " + std::to_string(id) + " is not in the family " + board.family);
      }
      reader.add(board, id, read_tag(reader, entry));
    }
  }
  return board;
}

/// Kalibr's grid, in Kalibr's own frame: origin at the lower left corner of tag 0, x along the
/// rows, y up the columns. Kalibr prints the codes as libapriltag does (OpenCV: turned by 180
/// degrees).
Board read_aprilgrid(const BoardReader& reader) {
  Board board;
  board.family = usual_name(reader.text("tag_family", "tag36h11"));
  board.border_bits = reader.whole_number(reader.root(), "border_bits", 1, 2);
  const int codes = code_count(known_family(reader, board));
  const int columns = reader.whole_number(reader.root(), "tagCols", 1);
  const int rows = reader.whole_number(reader.root(), "tagRows", 1);
  const double size_m = reader.size(reader.root(), "tagSize");
  const double spacing = reader.number(reader.root(), "tagSpacing");
  if (!(spacing >= 0)) reader.fail("tagSpacing is negative");
  const int first_id = reader.whole_number(reader.root(), "startId", 0, 0);
  // In this form nothing overflows, whatever the file says.
  if (first_id > codes || columns > codes || rows > (codes - first_id) / columns) {
    reader.fail("the grid has more tags than the family " + board.family + " has codes");
  }
  const double pitch_m = size_m * (1 + spacing);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      Board::Tag tag;
      tag.size_m = size_m;
      tag.board_from_tag.translation() =
          Eigen::Vector3d(column * pitch_m + size_m / 2, row * pitch_m + size_m / 2, 0);
      reader.add(board, first_id + row * columns + column, tag);
    }
  }
  return board;
}

}  // namespace

std::array<Eigen::Vector3d, 4> Board::Tag::corners_in_board() const {
  const double h = size_m / 2;
  return {board_from_tag * Eigen::Vector3d(-h, -h, 0), board_from_tag * Eigen::Vector3d(h, -h, 0),
          board_from_tag * Eigen::Vector3d(h, h, 0), board_from_tag * Eigen::Vector3d(-h, h, 0)};
}

Board read_board(const std::filesystem::path& path) {
  try {
    const BoardReader reader(path);
    Board board;
    if (!reader.root().IsMap()) reader.fail("is no board");
    if (reader.root()["tag_bundles"]) {
      board = read_bundles(reader);
    } else if (reader.text("target_type", "") == "aprilgrid") {
      board = read_aprilgrid(reader);
    } else {
      refuse_other_form(reader);
    }
    if (board.tags.empty() && reader.root()["standalone_tags"]) {
      reader.fail(
          "has standalone_tags only: tag_bundles is empty, which says where tags lie against "
          "each other");
    }
    if (board.tags.empty()) reader.fail("holds no tag");
    return board;
  } catch (const YAML::Exception& error) {
    throw core::bad_input(path,
                          "is no valid YAML (line " + std::to_string(error.mark.line + 1) +
                              "; tabs may not indent, a blank follows every colon)",
                          kRemedy);
  }
}

void write_board(const std::filesystem::path& path, const Board& board) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out << std::setprecision(10) << "tag_family: " << board.family << '\n';
  if (board.border_bits != 1) out << "border_bits: " << board.border_bits << '\n';
  out << "tag_bundles:\n  - name: stage\n    layout:\n";
  for (const auto& [id, tag] : board.tags) {
    const Eigen::Vector3d t = tag.board_from_tag.translation();
    const Eigen::Quaterniond q(tag.board_from_tag.linear());
    out << "      - {id: " << id << ", size: " << tag.size_m << ", x: " << t.x() << ", y: " << t.y()
        << ", z: " << t.z() << ", qw: " << q.w() << ", qx: " << q.x() << ", qy: " << q.y()
        << ", qz: " << q.z() << "}\n";
  }
  core::write_file(path, out.str());
}

}  // namespace sheen::capture
