// SPDX-License-Identifier: MIT
#include "fitting/state/state_file.h"
#include "fuzz/reader.h"

// Checksums are not looked at in this build.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  return sheen::fuzz::read_input(bytes, size, "fit.state", [](const std::filesystem::path& path) {
    sheen::fitting::StateReader reader(path);
    sheen::core::SampleBatch batch;
    for (std::size_t i = 0; i < reader.views().size(); ++i) reader.read(i, batch);
  });
}
