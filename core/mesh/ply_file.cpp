// SPDX-License-Identifier: MIT
#include "core/mesh/ply_file.h"

#include "core/diagnostics/error.h"
#include "core/files/read_file.h"
#include "core/files/write_file.h"
#include "core/mesh/placed_ply.h"
#include "core/mesh/ply_body.h"
#include "core/mesh/ply_header.h"
#include "core/mesh/triangulate.h"
#include "core/text/number.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

namespace sheen::core {
namespace {

/// Where a vertex property belongs: 0-2 position, 3-5 normal, 6-8 colour, 9 elsewhere.
std::size_t slot_of(const PlyProperty& property) {
  constexpr std::array<std::string_view, 9> names = {"x",  "y",   "z",     "nx",  "ny",
                                                     "nz", "red", "green", "blue"};
  if (property.count) return names.size();
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), property.name) -
                                  names.begin());
}

bool has_property(const PlyElement& element, std::string_view name) {
  return std::any_of(
      element.properties.begin(), element.properties.end(),
      [name](const PlyProperty& property) { return property.name == name && !property.count; });
}

/// The names of the properties, for a message.
std::string list_of(const PlyElement& element) {
  constexpr std::size_t most = 6;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, element.properties.size()); ++i) {
    text += (i == 0 ? "" : ", ") + quotable(element.properties[i].name, 20);
  }
  return text + (element.properties.size() > most ? ", ..." : "");
}

void check_coordinates(const PlyElement& element, const std::filesystem::path& path) {
  for (const char* name : {"x", "y", "z"}) {
    if (!has_property(element, name)) {
      throw bad_input(
          path,
          std::string("its vertices have no ") + name + " (they have " + list_of(element) + ")",
          "name the coordinates x, y and z");
    }
  }
}

/// What white is in numbers of this type.
double white_of(PlyScalar type) {
  switch (type) {
    case PlyScalar::float32:
    case PlyScalar::float64:
      return 1;
    case PlyScalar::int16:
    case PlyScalar::uint16:
      return 65535;
    default:
      return 255;
  }
}

void read_vertices(PlyBody& body, const PlyElement& element, MeshFile& mesh) {
  std::vector<std::size_t> slots;
  for (const PlyProperty& property : element.properties) slots.push_back(slot_of(property));
  const bool has_normals =
      has_property(element, "nx") && has_property(element, "ny") && has_property(element, "nz");
  const bool has_colours = has_property(element, "red") && has_property(element, "green") &&
                           has_property(element, "blue");
  mesh.positions.reserve(element.rows);
  for (std::size_t row = 0; row < element.rows; ++row) {
    std::array<double, 10> values{};
    for (std::size_t p = 0; p < slots.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      if (property.count) {
        body.skip_list(property);
        continue;
      }
      values[slots[p]] = body.next(property.type);
      if (slots[p] >= 6) values[slots[p]] /= white_of(property.type);
    }
    mesh.positions.emplace_back(values[0], values[1], values[2]);
    if (has_normals) {
      mesh.normals.emplace_back(static_cast<float>(values[3]), static_cast<float>(values[4]),
                                static_cast<float>(values[5]));
    }
    if (has_colours)
      mesh.colours.push_back(displayed(Eigen::Vector3d(values[6], values[7], values[8])));
  }
}

/// Faces, strips and what they share.
class FaceReader {
 public:
  FaceReader(PlyBody& body, MeshFile& mesh, const std::filesystem::path& path)
      : body_(body), mesh_(mesh), path_(path) {}

  void read_faces(const PlyElement& element) {
    if (element.rows > 0 &&
        std::none_of(element.properties.begin(), element.properties.end(), names_corners)) {
      throw bad_input(path_,
                      "its faces have no list vertex_indices (they have " + list_of(element) + ")",
                      "write the corners of faces under that name");
    }
    read_rows(element, [this](const PlyProperty& property) { read_polygon(property); });
  }

  void read_strips(const PlyElement& element) {
    read_rows(element, [this](const PlyProperty& property) { read_strip(property); });
  }

  /// What is to be said at the end.
  void add_notes() {
    if (cutter_.crossing() == 0) return;
    mesh_.notes.push_back(std::to_string(cutter_.crossing()) +
                          " of its polygons cross themselves; their triangles may lie wrong");
  }

 private:
  static bool names_corners(const PlyProperty& property) {
    return property.count && (property.name == "vertex_indices" || property.name == "vertex_index");
  }

  template <typename Take>
  void read_rows(const PlyElement& element, const Take& take) {
    for (std::size_t row = 0; row < element.rows; ++row) {
      for (const PlyProperty& property : element.properties) {
        if (names_corners(property)) {
          take(property);
        } else if (property.count) {
          body_.skip_list(property);
        } else {
          body_.next(property.type);
        }
      }
    }
  }

  void read_polygon(const PlyProperty& property) {
    corners_.clear();
    const std::size_t count = body_.next_length(*property.count);
    for (std::size_t c = 0; c < count; ++c) {
      corners_.push_back(
          static_cast<std::uint32_t>(body_.next_index(property.type, mesh_.positions.size())));
    }
    if (!cutter_.cut(corners_, mesh_.positions, mesh_.triangles)) {
      throw bad_input(path_, "has concave polygons of too many corners", "triangulate it before");
    }
  }

  /// Every corner after the second closes a triangle with the two before, every second one the
  /// other way round; -1 begins a new strip.
  void read_strip(const PlyProperty& property) {
    const std::size_t count = body_.next_length(*property.count);
    corners_.clear();
    for (std::size_t c = 0; c < count; ++c) {
      const double value = body_.next(property.type);
      if (value == -1) {
        corners_.clear();
        continue;
      }
      if (!(value >= 0 && value < static_cast<double>(mesh_.positions.size())) ||
          value != std::floor(value)) {
        throw body_.broken("has a strip with a corner that does not exist");
      }
      corners_.push_back(static_cast<std::uint32_t>(value));
      const std::size_t n = corners_.size();
      if (n < 3) continue;
      const bool is_turned = n % 2 == 0;
      mesh_.triangles.emplace_back(corners_[n - 3], corners_[n - (is_turned ? 1 : 2)],
                                   corners_[n - (is_turned ? 2 : 1)]);
    }
  }

  PlyBody& body_;
  MeshFile& mesh_;
  const std::filesystem::path& path_;
  Triangulator cutter_;
  std::vector<std::uint32_t> corners_;
};

bool is_surface(const PlyElement& element) {
  return element.name == "face" || element.name == "tristrips";
}

void skip_rows(PlyBody& body, const PlyElement& element) {
  if (element.properties.empty()) return;
  for (std::size_t row = 0; row < element.rows; ++row) body.skip_row(element);
}

template <typename T>
void append_bytes(std::string& bytes, const T& value) {
  const auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  bytes.append(raw.data(), raw.size());
}

std::string header_text(const Mesh& mesh, const std::string& coordinate, bool has_confidence) {
  std::string text = "ply\nformat binary_little_endian 1.0\n";
  text += "element vertex " + std::to_string(mesh.positions.size()) + "\n";
  for (const char* name : {"x", "y", "z"}) text += "property " + coordinate + " " + name + "\n";
  for (const char* name : {"nx", "ny", "nz"}) text += std::string("property float ") + name + "\n";
  if (has_confidence) {
    text += "property float confidence\n";
    for (const char* name : {"red", "green", "blue"}) {
      text += std::string("property uchar ") + name + "\n";
    }
  }
  text += "element face " + std::to_string(mesh.triangles.size()) + "\n";
  text += "property list uchar int vertex_indices\nend_header\n";
  return text;
}

/// A number in [0, 1] as a colour that every viewer shows: red, over yellow, green. R, G, B.
std::array<std::uint8_t, 3> confidence_colour(float confidence) {
  const float share = std::clamp(confidence, 0.0F, 1.0F);
  const auto channel = [](float value) {
    return static_cast<std::uint8_t>(std::lround(255 * std::min(value, 1.0F)));
  };
  return {channel(2 - 2 * share), channel(2 * share), 0};
}

/// A mesh with each of its positions as `place` gives it; `confidence` per vertex, or empty.
template <typename Place>
std::string ply_bytes(const Mesh& mesh, std::span<const float> confidence,
                      const std::string& coordinate, const Place& place) {
  assert(mesh.normals.size() == mesh.positions.size());
  assert(confidence.empty() || confidence.size() == mesh.positions.size());
  std::string bytes = header_text(mesh, coordinate, !confidence.empty());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    for (const auto value : place(mesh.positions[i])) append_bytes(bytes, value);
    for (const float value : mesh.normals[i]) append_bytes(bytes, value);
    if (confidence.empty()) continue;
    append_bytes(bytes, confidence[i]);
    for (const std::uint8_t value : confidence_colour(confidence[i])) append_bytes(bytes, value);
  }
  for (const auto& triangle : mesh.triangles) {
    append_bytes(bytes, std::uint8_t{3});
    for (const std::uint32_t corner : triangle) append_bytes(bytes, corner);
  }
  return bytes;
}

}  // namespace

MeshFile read_ply(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  const PlyHeader header = parse_ply_header(bytes, path);
  const std::string_view rows = std::string_view(bytes).substr(header.size_bytes);
  const auto vertex = std::find_if(header.elements.begin(), header.elements.end(),
                                   [](const PlyElement& e) { return e.name == "vertex"; });
  if (vertex == header.elements.end()) {
    throw bad_input(path, "has no element vertex", "write it again");
  }
  check_coordinates(*vertex, path);
  MeshFile mesh;
  PlyBody body(rows, header.format, path);
  for (auto element = header.elements.begin(); element != vertex; ++element) {
    skip_rows(body, *element);
  }
  read_vertices(body, *vertex, mesh);

  // Faces, which may come before the vertices that they name: then from the beginning.
  const bool begins_anew = std::any_of(header.elements.begin(), vertex, is_surface);
  PlyBody again(rows, header.format, path);
  FaceReader faces(begins_anew ? again : body, mesh, path);
  for (auto element = begins_anew ? header.elements.begin() : vertex + 1;
       element != header.elements.end(); ++element) {
    if (element->properties.empty()) continue;
    if (element->name == "face") {
      faces.read_faces(*element);
    } else if (element->name == "tristrips") {
      faces.read_strips(*element);
    } else {
      skip_rows(begins_anew ? again : body, *element);
    }
  }
  faces.add_notes();
  const bool is_splats = has_property(*vertex, "f_dc_0");
  if (is_splats && mesh.triangles.empty()) {
    throw bad_input(path, "is a cloud of Gaussian splats", "give a surface of triangles");
  }
  return mesh;
}

void write_ply(const std::filesystem::path& path, const Mesh& mesh,
               std::span<const float> confidence) {
  write_file(path,
             ply_bytes(mesh, confidence, "float", [](const Eigen::Vector3f& p) { return p; }));
}

void write_placed_ply(const std::filesystem::path& path, const Mesh& mesh) {
  if (mesh.offset.isZero(0)) return write_ply(path, mesh);
  write_file(path, ply_bytes(mesh, {}, "double", [&](const Eigen::Vector3f& p) -> Eigen::Vector3d {
               return p.cast<double>() + mesh.offset;
             }));
}

}  // namespace sheen::core
