// SPDX-License-Identifier: MIT
#include "core/mesh/coloured_ply.h"

#include "core/files/write_file.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <string>

namespace sheen::core {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is little-endian");

template <typename Value>
void append_value(std::string& bytes, Value value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string coloured_header(const Mesh& mesh, const std::string& coordinate, bool has_confidence) {
  std::string text = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                     std::to_string(mesh.positions.size()) + "\n";
  for (const char* name : {"x", "y", "z"}) text += "property " + coordinate + " " + name + "\n";
  for (const char* name : {"nx", "ny", "nz"}) text += std::string("property float ") + name + "\n";
  for (const char* name : {"red", "green", "blue"}) {
    text += std::string("property uchar ") + name + "\n";
  }
  if (has_confidence) {
    text += "property float confidence\n";
    for (const char* name : {"seen_0", "seen_1", "seen_2", "seen_3"}) {
      text += std::string("property ushort ") + name + "\n";
    }
  }
  return text + "element face " + std::to_string(mesh.triangles.size()) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

}  // namespace

void write_coloured_ply(const std::filesystem::path& path, const Mesh& mesh,
                        std::span<const Eigen::Vector3f> colours,
                        std::span<const VertexConfidence> confidence) {
  assert(colours.size() == mesh.positions.size());
  assert(confidence.empty() || confidence.size() == colours.size());
  const bool lies_far = !mesh.offset.isZero();
  std::string bytes = coloured_header(mesh, lies_far ? "double" : "float", !confidence.empty());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const float value = mesh.positions[i][axis];
      lies_far ? append_value(bytes, static_cast<double>(value) + mesh.offset[axis])
               : append_value(bytes, value);
    }
    for (const float value : mesh.normals[i]) append_value(bytes, value);
    for (const float channel : colours[i]) {
      const float byte = std::round(255.0f * std::clamp(channel, 0.0f, 1.0f));
      append_value(bytes, static_cast<std::uint8_t>(byte));
    }
    if (!confidence.empty()) {
      append_value(bytes, confidence[i].mean);
      append_value(bytes, confidence[i].seen);
    }
  }
  for (const auto& triangle : mesh.triangles) {
    append_value(bytes, std::uint8_t{3});
    for (const std::uint32_t corner : triangle) append_value(bytes, corner);
  }
  write_file(path, bytes);
}

}  // namespace sheen::core
