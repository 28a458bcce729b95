// SPDX-License-Identifier: MIT
#include "capture/registration/placement.h"

#include "fuzz/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  return sheen::fuzz::read_input(bytes, size, "pairs.txt", [](const std::filesystem::path& path) {
    sheen::capture::place_by_pairs(sheen::capture::read_point_pairs(path), path);
  });
}
