// SPDX-License-Identifier: MIT
#include "capture/dataset/bundler_file.h"
#include "fuzz/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  return sheen::fuzz::read_input(bytes, size, "bundle.out", [](const std::filesystem::path& path) {
    // The images that the bundle's cameras took.
    const std::filesystem::path images =
        std::filesystem::path(SHEEN_FUZZ_SESSION) / "held_out" / "images";
    static const bool is_listed = [&] {
      std::ofstream(path.parent_path() / "list.txt") << "0000.png\n0001.png\n";
      return true;
    }();
    (void)is_listed;
    sheen::capture::read_bundle(path, images);
  });
}
