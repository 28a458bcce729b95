// SPDX-License-Identifier: MIT
#include "capture/source/still_reader.h"
#include "fuzz/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  return sheen::fuzz::read_input(bytes, size, "0000.png", [](const std::filesystem::path& path) {
    sheen::capture::StillReader().read(path, std::nullopt);
  });
}
