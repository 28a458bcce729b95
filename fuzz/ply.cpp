// SPDX-License-Identifier: MIT
#include "core/mesh/read_mesh.h"
#include "fuzz/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  return sheen::fuzz::read_input(bytes, size, "mesh.ply", [](const std::filesystem::path& path) {
    sheen::core::read_mesh(path);
  });
}
