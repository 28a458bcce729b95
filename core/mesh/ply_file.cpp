// SPDX-License-Identifier: MIT
#include "core/mesh/ply_file.h"

#include "core/diagnostics/error.h"
#include "core/files/write_file.h"
#include "core/mesh/ply_header.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>

namespace sheen::core {
namespace {

static_assert(std::endian::native == std::endian::little, "bytes are written as they lie");

/// Reads one number after the other, whatever the format; none is read past the end.
class PlyBody {
 public:
  PlyBody(std::string_view bytes, PlyFormat format, const std::filesystem::path& path)
      : rest_(bytes), format_(format), path_(path) {}

  double next(PlyScalar type) {
    if (format_ == PlyFormat::ascii) return next_word();
    switch (type) {
      case PlyScalar::int8:
        return next_binary<std::int8_t>();
      case PlyScalar::uint8:
        return next_binary<std::uint8_t>();
      case PlyScalar::int16:
        return next_binary<std::int16_t>();
      case PlyScalar::uint16:
        return next_binary<std::uint16_t>();
      case PlyScalar::int32:
        return next_binary<std::int32_t>();
      case PlyScalar::uint32:
        return next_binary<std::uint32_t>();
      case PlyScalar::float32:
        return static_cast<double>(next_binary<float>());
      case PlyScalar::float64:
        return next_binary<double>();
    }
    throw broken("names a type that does not exist");
  }

  /// A list's length or a vertex index: an integer in [0, end).
  std::size_t next_integer(PlyScalar type, std::size_t end, const std::string& fault) {
    const double value = next(type);
    if (!(value >= 0 && value < static_cast<double>(end)) || value != std::floor(value)) {
      throw broken(fault);
    }
    return static_cast<std::size_t>(value);
  }

  /// Length of a list; every entry takes at least one byte.
  std::size_t next_length(PlyScalar type) {
    return next_integer(type, rest_.size() + 1,
                        "is cut short or holds a list of impossible length");
  }

 private:
  template <typename T>
  T next_binary() {
    if (rest_.size() < sizeof(T)) throw broken("is cut short");
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), rest_.data(), sizeof(T));
    if (format_ == PlyFormat::big_endian) std::reverse(raw.begin(), raw.end());
    rest_.remove_prefix(sizeof(T));
    return std::bit_cast<T>(raw);
  }

  double next_word() {
    constexpr std::string_view space = " \t\r\n";
    const std::size_t begin = rest_.find_first_not_of(space);
    if (begin == std::string_view::npos) throw broken("is cut short");
    rest_.remove_prefix(begin + (rest_[begin] == '+' ? 1 : 0));
    double value = 0;
    const auto parsed = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    if (parsed.ec != std::errc()) throw broken("holds a word that is not a number");
    rest_.remove_prefix(static_cast<std::size_t>(parsed.ptr - rest_.data()));
    if (!rest_.empty() && space.find(rest_.front()) == std::string_view::npos) {
      throw broken("holds a word that is not a number");
    }
    return value;
  }

  [[nodiscard]] Error broken(const std::string& fault) const {
    return bad_input(path_, fault, "write it again");
  }

  std::string_view rest_;
  PlyFormat format_;
  const std::filesystem::path& path_;
};

void skip_list(PlyBody& body, const PlyProperty& property) {
  const std::size_t length = body.next_length(*property.count);
  for (std::size_t i = 0; i < length; ++i) body.next(property.type);
}

/// Where a vertex property belongs: 0-2 position, 3-5 normal, 6 elsewhere.
std::size_t slot_of(const PlyProperty& property) {
  constexpr std::array<std::string_view, 6> names = {"x", "y", "z", "nx", "ny", "nz"};
  if (property.count) return names.size();
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), property.name) -
                                  names.begin());
}

void read_vertices(PlyBody& body, const PlyElement& element, Mesh& mesh) {
  std::vector<std::size_t> slots;
  for (const PlyProperty& property : element.properties) slots.push_back(slot_of(property));
  const bool has_normals = std::count(slots.begin(), slots.end(), 3U) +
                               std::count(slots.begin(), slots.end(), 4U) +
                               std::count(slots.begin(), slots.end(), 5U) ==
                           3;
  mesh.positions.reserve(element.rows);
  for (std::size_t row = 0; row < element.rows; ++row) {
    std::array<float, 7> values{};
    for (std::size_t p = 0; p < slots.size(); ++p) {
      if (element.properties[p].count) {
        skip_list(body, element.properties[p]);
      } else {
        values[slots[p]] = static_cast<float>(body.next(element.properties[p].type));
      }
    }
    mesh.positions.emplace_back(values[0], values[1], values[2]);
    if (has_normals) mesh.normals.emplace_back(values[3], values[4], values[5]);
  }
}

/// One polygon as a fan around its first corner.
void read_polygon(PlyBody& body, const PlyProperty& property, Mesh& mesh) {
  const std::size_t corners = body.next_length(*property.count);
  Eigen::Matrix<std::uint32_t, 3, 1> triangle(0, 0, 0);
  for (std::size_t c = 0; c < corners; ++c) {
    const auto corner = static_cast<std::uint32_t>(body.next_integer(
        property.type, mesh.positions.size(), "has a face with a corner that does not exist"));
    if (c == 0) triangle[0] = corner;
    triangle[1] = triangle[2];
    triangle[2] = corner;
    if (c >= 2) mesh.triangles.push_back(triangle);
  }
}

void read_faces(PlyBody& body, const PlyElement& element, Mesh& mesh) {
  for (std::size_t row = 0; row < element.rows; ++row) {
    for (const PlyProperty& property : element.properties) {
      const bool is_polygon = property.name == "vertex_indices" || property.name == "vertex_index";
      if (is_polygon && property.count) {
        read_polygon(body, property, mesh);
      } else if (property.count) {
        skip_list(body, property);
      } else {
        body.next(property.type);
      }
    }
  }
}

void skip_rows(PlyBody& body, const PlyElement& element) {
  if (element.properties.empty()) return;
  for (std::size_t row = 0; row < element.rows; ++row) {
    for (const PlyProperty& property : element.properties) {
      if (property.count) {
        skip_list(body, property);
      } else {
        body.next(property.type);
      }
    }
  }
}

std::string all_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  if (!file.is_open() || file.bad()) throw bad_input(path, "cannot be read", "check permissions");
  return bytes;
}

template <typename T>
void append_bytes(std::string& bytes, const T& value) {
  const auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  bytes.append(raw.data(), raw.size());
}

std::string header_text(const Mesh& mesh) {
  std::string text = "ply\nformat binary_little_endian 1.0\n";
  text += "element vertex " + std::to_string(mesh.positions.size()) + "\n";
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) {
    text += std::string("property float ") + name + "\n";
  }
  text += "element face " + std::to_string(mesh.triangles.size()) + "\n";
  text += "property list uchar int vertex_indices\nend_header\n";
  return text;
}

}  // namespace

Mesh read_ply(const std::filesystem::path& path) {
  const std::string bytes = all_bytes(path);
  const PlyHeader header = parse_ply_header(bytes, path);
  PlyBody body(std::string_view(bytes).substr(header.size_bytes), header.format, path);
  Mesh mesh;
  for (const PlyElement& element : header.elements) {
    if (element.name == "vertex" && mesh.positions.empty()) {
      if (element.properties.empty()) throw bad_input(path, "has empty vertices", "write it again");
      read_vertices(body, element, mesh);
    } else if (element.name == "face" && !element.properties.empty()) {
      read_faces(body, element, mesh);
    } else {
      skip_rows(body, element);
    }
  }
  return mesh;
}

void write_ply(const std::filesystem::path& path, const Mesh& mesh) {
  assert(mesh.normals.size() == mesh.positions.size());
  std::string bytes = header_text(mesh);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    for (const float value : mesh.positions[i]) append_bytes(bytes, value);
    for (const float value : mesh.normals[i]) append_bytes(bytes, value);
  }
  for (const auto& triangle : mesh.triangles) {
    append_bytes(bytes, std::uint8_t{3});
    for (const std::uint32_t corner : triangle) append_bytes(bytes, corner);
  }

  write_file(path, bytes);
}

}  // namespace sheen::core
