// SPDX-License-Identifier: MIT
#pragma once

#include <random>
#include <string>

namespace sheen::capture::test {

/// What a power cut leaves of a file that was flushed when it held `flushed` and was written on to
/// `written`: each of its blocks is as it was flushed (beyond that: zeros) or as it was written
/// last, whichever the disk had come to, and its end may lie anywhere between.
inline std::string after_power_cut(const std::string& flushed, const std::string& written,
                                   std::mt19937& random) {
  constexpr std::size_t block = 512;
  std::string left = flushed + std::string(written.size() - flushed.size(), '\0');
  for (std::size_t at = 0; at < left.size(); at += block) {
    if (random() % 2 == 0) left.replace(at, block, written, at, block);
  }
  return left.substr(0, flushed.size() + random() % (written.size() - flushed.size() + 1));
}

}  // namespace sheen::capture::test
