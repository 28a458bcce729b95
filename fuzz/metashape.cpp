// SPDX-License-Identifier: MIT
#include "capture/dataset/metashape_file.h"
#include "fuzz/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  return sheen::fuzz::read_input(bytes, size, "cameras.xml", [](const std::filesystem::path& path) {
    sheen::capture::read_metashape(path, path.parent_path());
  });
}
