// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

namespace sheen::capture {

/// An image on its way from the camera: shared, since disk, fit and screen take it at their pace.
struct LiveImage {
  std::shared_ptr<const std::vector<std::uint8_t>> bytes;
  std::int64_t time_us = 0;    ///< since the first image
  std::uint32_t sequence = 0;  ///< the camera's own count
  bool is_key = true;          ///< can be decoded without those before it
};

/// The file, or files, of a recording's images, which grow at their end only until they are closed:
/// what was appended is found whatever happens then. Used from one thread but for `flush`.
class RecordedVideo {
 public:
  virtual ~RecordedVideo() = default;

  /// Returns 0 or errno; after a fault the image does not count.
  [[nodiscard]] virtual int append(const LiveImage& image) = 0;

  /// Completes indices and headers. Returns 0 or errno; after a fault the file stays open-ended.
  [[nodiscard]] virtual int close() = 0;

  /// Waits until the disk has everything; from any thread. Returns 0 or errno.
  [[nodiscard]] virtual int flush() const = 0;

  /// Of the video's file, whole images only.
  [[nodiscard]] virtual std::uint64_t bytes() const = 0;
};

}  // namespace sheen::capture
