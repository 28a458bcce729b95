// SPDX-License-Identifier: MIT
#include "core/mesh/read_mesh.h"
#include "fuzz/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  return sheen::fuzz::read_input(bytes, size, "mesh.glb", [](const std::filesystem::path& path) {
    std::vector<Eigen::Vector3f> colours;
    sheen::core::read_mesh(path, nullptr, &colours);
  });
}
