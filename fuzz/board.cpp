// SPDX-License-Identifier: MIT
#include "capture/pose/board.h"

#include "fuzz/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  return sheen::fuzz::read_input(bytes, size, "board.yaml", [](const std::filesystem::path& path) {
    sheen::capture::read_board(path);
  });
}
