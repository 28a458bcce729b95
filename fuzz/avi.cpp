// SPDX-License-Identifier: MIT
#include "capture/source/motion_jpeg_source.h"
#include "fuzz/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  return sheen::fuzz::read_input(bytes, size, "frames.avi", [](const std::filesystem::path& path) {
    const auto source = sheen::capture::open_motion_jpeg(path, {160, 120}, {0, 20}, 30.0, 1.0);
    while (source && source->next()) {
    }
  });
}
