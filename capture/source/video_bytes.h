// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace sheen::capture {

/// The bytes of a video that is still being recorded, one after the other.
class VideoBytes {
 public:
  virtual ~VideoBytes() = default;

  /// Waits for bytes and takes as many as there are, at most `bytes`.size(); 0 at the end.
  virtual std::size_t read(std::span<std::uint8_t> bytes) = 0;
};

}  // namespace sheen::capture
