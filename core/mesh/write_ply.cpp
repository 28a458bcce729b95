// SPDX-License-Identifier: MIT
#include "core/diagnostics/error.h"
#include "core/files/staged_output.h"
#include "core/mesh/read_mesh.h"

#include <array>
#include <bit>
#include <cassert>
#include <fstream>
#include <string>

namespace sheen::core {
namespace {

static_assert(std::endian::native == std::endian::little, "bytes are written as they lie");

template <typename T>
void append_bytes(std::string& bytes, const T& value) {
  const auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  bytes.append(raw.data(), raw.size());
}

std::string header(const Mesh& mesh) {
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

void write_ply(const std::filesystem::path& path, const Mesh& mesh) {
  assert(mesh.normals.size() == mesh.positions.size());
  // Lay out.
  std::string bytes = header(mesh);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    for (const float value : mesh.positions[i]) append_bytes(bytes, value);
    for (const float value : mesh.normals[i]) append_bytes(bytes, value);
  }
  for (const auto& triangle : mesh.triangles) {
    append_bytes(bytes, std::uint8_t{3});
    for (const std::uint32_t corner : triangle) append_bytes(bytes, corner);
  }

  // Write and move into place.
  StagedOutput output(path);
  std::ofstream file(output.path(), std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) {
    throw Error(Error::Kind::run_failed, path, "cannot be written", "check free space");
  }
  output.commit();
}

}  // namespace sheen::core
