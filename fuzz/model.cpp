// SPDX-License-Identifier: MIT
#include "fitting/model_file/checksum.h"
#include "fitting/model_file/model_file.h"
#include "fuzz/reader.h"

// Seeds hold the checksum's placeholder, so that altered files pass its test and reach the readers.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  std::string file(bytes, bytes + size);
  if (file.find(sheen::fitting::kChecksumPlaceholder) != std::string::npos) {
    sheen::fitting::write_checksum(file);
  }
  return sheen::fuzz::read_input(
      reinterpret_cast<const std::uint8_t*>(file.data()), file.size(), "model.glb",
      [](const std::filesystem::path& path) { sheen::fitting::read_model(path); });
}
