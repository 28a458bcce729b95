// SPDX-License-Identifier: MIT
#include "capture/source/video_source.h"
#include "fuzz/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  return sheen::fuzz::read_input(bytes, size, "frames.mkv", [](const std::filesystem::path& path) {
    const auto source = sheen::capture::open_video(path, {160, 120}, {0, 20}, std::nullopt);
    while (source->next()) {
    }
  });
}
