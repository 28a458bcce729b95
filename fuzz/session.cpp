// SPDX-License-Identifier: MIT
#include "capture/session/session.h"

#include "fuzz/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  return sheen::fuzz::read_input(
      bytes, size, "session.json", [](const std::filesystem::path& path) {
        // What the session may name.
        const std::filesystem::path folder = path.parent_path();
        for (const char* name : {"camera.yaml", "board.yaml", "object.ply", "frames.avi"}) {
          if (std::filesystem::exists(folder / name)) continue;
          std::filesystem::create_symlink(std::filesystem::path(SHEEN_FUZZ_SESSION) / name,
                                          folder / name);
        }
        sheen::capture::open_session(folder);
      });
}
