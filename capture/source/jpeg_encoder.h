// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/camera.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace sheen::capture {

/// Packs raw images of a camera as JPEG of quality 95, chroma as finely sampled as the camera
/// did. Luma and chroma are taken as ITU-R BT.601 in limited range, what V4L2 says of cameras, and
/// become JPEG's full range. A few ms of CPU at 1280x720.
class JpegEncoder {
 public:
  JpegEncoder();

  /// The image as JPEG; empty when `raw` is a JPEG itself or holds fewer bytes than its size
  /// asks.
  [[nodiscard]] std::vector<std::uint8_t> encode(const CameraBuffer& raw);

 private:
  struct Destroy {
    void operator()(void* codec) const;
  };

  bool split_yuyv(const CameraBuffer& raw);
  bool split_nv12(const CameraBuffer& raw);

  std::unique_ptr<void, Destroy> codec_;
  std::vector<std::uint8_t> y_, u_, v_;
};

}  // namespace sheen::capture
