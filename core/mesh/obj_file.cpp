// SPDX-License-Identifier: MIT
#include "core/mesh/obj_file.h"

#include "core/diagnostics/error.h"
#include "core/files/read_file.h"
#include "core/mesh/triangulate.h"
#include "core/text/number.h"
#include "core/text/text_form.h"

#include <array>
#include <optional>
#include <string_view>
#include <unordered_map>

namespace sheen::core {
namespace {

constexpr std::string_view kBlanks = " \t";
constexpr std::uint32_t kNoNormal = 0xffffffffU;

/// Takes the first word off `line`; empty at its end.
std::string_view next_word(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(kBlanks));
  line.remove_prefix(word.size());
  return word;
}

class ObjReader {
 public:
  ObjReader(const std::filesystem::path& path, VertexColours colours)
      : path_(path), reads_colours_(colours == VertexColours::read) {}

  MeshFile read() {
    std::string text = read_file(path_);
    normalise_text(text, path_);
    for (std::size_t begin = 0; begin < text.size();) {
      ++line_;
      std::size_t end = line_end(text, begin);
      const std::size_t joined = join_continued_lines(text, begin, end);
      take(std::string_view(text).substr(begin, end - begin));
      line_ += joined;
      begin = end + 1;
    }
    if (!has_normals_) mesh_.normals.clear();
    add_colours();
    if (cutter_.crossing() > 0) {
      mesh_.notes.push_back(std::to_string(cutter_.crossing()) +
                            " of its polygons cross themselves; their triangles may lie wrong");
    }
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const std::string& fault) const {
    throw bad_input(path_, "line " + std::to_string(line_) + " " + fault, "write it again");
  }

  static std::size_t line_end(const std::string& text, std::size_t begin) {
    return std::min(text.find('\n', begin), text.size());
  }

  /// A backslash at the end of a line of numbers joins the next one to it; comments and names of
  /// groups may end with one, as folders do. Moves `end` and returns the lines joined.
  static std::size_t join_continued_lines(std::string& text, std::size_t begin, std::size_t& end) {
    std::string_view line = std::string_view(text).substr(begin, end - begin);
    if (!line.ends_with('\\')) return 0;
    const std::string_view keyword = next_word(line);
    if (keyword != "v" && keyword != "vn" && keyword != "f" && keyword != "fo") return 0;
    std::size_t joined = 0;
    for (; end < text.size() && text[end - 1] == '\\'; ++joined) {
      text[end - 1] = text[end] = ' ';
      end = line_end(text, end);
    }
    return joined;
  }

  void take(std::string_view line) {
    const std::string_view keyword = next_word(line);
    if (keyword == "v") {
      positions_.push_back(read_triple(line));
      if (reads_colours_) read_colour(line);
    } else if (keyword == "vn") {
      normals_.push_back(read_triple(line).cast<float>());
    } else if (keyword == "f" || keyword == "fo") {
      read_face(line);
    }
    if (positions_.size() > 4 * kMostVertices) {
      throw bad_input(path_, "has more than 80 million vertices", "simplify it");
    }
  }

  Eigen::Vector3d read_triple(std::string_view& line) {
    Eigen::Vector3d triple;
    for (double& number : triple) {
      const std::string_view word = next_word(line);
      const auto value = parse_number(word);
      if (!value) fail("holds something that is not a number (" + why_no_number(word) + ")");
      number = *value;
    }
    return triple;
  }

  /// What stands behind a position: three numbers are a colour; one, a weight, is none.
  void read_colour(std::string_view line) {
    Eigen::Vector3d rgb;
    for (double& number : rgb) {
      const auto value = parse_number(next_word(line));
      if (!value) return;
      number = *value;
    }
    colours_.resize(positions_.size() - 1, Eigen::Vector3f::Zero());
    colours_.push_back(displayed(rgb));
    ++coloured_;
  }

  /// Those of the vertices that faces use.
  void add_colours() {
    if (coloured_ == 0) return;
    if (coloured_ < positions_.size()) {
      mesh_.notes.emplace_back("has colours at some of its vertices only, which are passed over");
      return;
    }
    for (const std::uint32_t position : position_of_) mesh_.colours.push_back(colours_[position]);
  }

  /// An index as written, to one from 0; 0 and what lies outside do not exist.
  [[nodiscard]] std::uint32_t index_of(std::string_view word, std::size_t count) const {
    const auto written = parse_whole_number(word);
    const auto size = static_cast<long long>(count);
    if (!written || *written == 0 || *written > size || *written < -size) {
      fail("has a face with a corner that does not exist (" + quotable(word) + ")");
    }
    return static_cast<std::uint32_t>(*written > 0 ? *written - 1 : size + *written);
  }

  /// position, position/texture, position//normal or position/texture/normal
  [[nodiscard]] std::uint32_t corner_of(std::string_view word) {
    const std::size_t slash = word.find('/');
    const std::uint32_t position = index_of(word.substr(0, slash), positions_.size());
    std::uint32_t normal = kNoNormal;
    const std::size_t second = slash == std::string_view::npos ? slash : word.find('/', slash + 1);
    if (second != std::string_view::npos && second + 1 < word.size()) {
      normal = index_of(word.substr(second + 1), normals_.size());
    }
    return vertex_of(position, normal);
  }

  std::uint32_t vertex_of(std::uint32_t position, std::uint32_t normal) {
    const std::uint64_t pair = std::uint64_t{position} << 32U | normal;
    const auto next = static_cast<std::uint32_t>(mesh_.positions.size());
    const auto [entry, is_new] = vertices_.try_emplace(pair, next);
    if (!is_new) return entry->second;
    if (mesh_.positions.size() >= kMostVertices) {
      throw bad_input(path_, "has more than 20 million vertices", "simplify it");
    }
    has_normals_ |= normal != kNoNormal;
    mesh_.positions.push_back(positions_[position]);
    if (reads_colours_) position_of_.push_back(position);
    mesh_.normals.push_back(normal == kNoNormal ? Eigen::Vector3f(Eigen::Vector3f::Zero())
                                                : normals_[normal]);
    return next;
  }

  void read_face(std::string_view line) {
    corners_.clear();
    for (auto word = next_word(line); !word.empty(); word = next_word(line)) {
      if (word.front() == '#') break;
      corners_.push_back(corner_of(word));
    }
    if (!cutter_.cut(corners_, mesh_.positions, mesh_.triangles)) {
      throw bad_input(path_, "has concave polygons of too many corners", "triangulate it before");
    }
    if (mesh_.triangles.size() > kMostTriangles) {
      throw bad_input(path_, "has more than 40 million triangles", "simplify it");
    }
  }

  const std::filesystem::path& path_;
  std::size_t line_ = 0;
  std::vector<Eigen::Vector3d> positions_;  ///< all `v` so far
  std::vector<Eigen::Vector3f> normals_;    ///< all `vn` so far
  bool reads_colours_;
  std::vector<Eigen::Vector3f> colours_;    ///< of the positions up to the last that has one
  std::size_t coloured_ = 0;                ///< positions that have one
  std::vector<std::uint32_t> position_of_;  ///< of every vertex of the mesh, where colours are read
  MeshFile mesh_;
  bool has_normals_ = false;
  std::unordered_map<std::uint64_t, std::uint32_t> vertices_;  ///< pair of indices -> vertex
  std::vector<std::uint32_t> corners_;
  Triangulator cutter_;
};

}  // namespace

MeshFile read_obj(const std::filesystem::path& path, VertexColours colours) {
  return ObjReader(path, colours).read();
}

}  // namespace sheen::core
