// SPDX-License-Identifier: MIT
#include "capture/session/frame_stamps.h"
#include "fuzz/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  return sheen::fuzz::read_input(bytes, size, "frames.csv", [](const std::filesystem::path& path) {
    sheen::capture::read_stamps(path);
  });
}
