// SPDX-License-Identifier: MIT
#pragma once

#include "core/diagnostics/error.h"

#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

namespace sheen::fuzz {

/// Writes one input as a file of the name in a folder of this process and gives it to `read`, which
/// may return or throw core::Error (bad_input); anything else is a finding.
template <class Read>
int read_input(const std::uint8_t* bytes, std::size_t size, const char* name, const Read& read) {
  static const std::filesystem::path folder =
      std::filesystem::path("/dev/shm") / ("sheen-fuzz-" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  const std::filesystem::path path = folder / name;
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes), static_cast<std::streamsize>(size));
  try {
    read(path);
  } catch (const core::Error& error) {
    if (std::string(error.what()).find('\n') != std::string::npos) __builtin_trap();  // one line
  }
  return 0;
}

}  // namespace sheen::fuzz
