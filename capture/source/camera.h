// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace sheen::capture {

/// How a camera packs an image: JPEG, 4:2:2 as Y U Y V, a plane of Y and one of U V at 4:2:0, or a
/// picture of a compressed video, which needs those before it.
enum class PixelFormat { mjpeg, yuyv, nv12, video };

/// What a decoder has to know of a compressed video before its first picture.
struct VideoHeader {
  std::string codec;                ///< FFmpeg's name: h264 or hevc
  std::vector<std::uint8_t> setup;  ///< parameter sets, Annex B
};

/// One image as the camera's own bytes.
struct CameraBuffer {
  PixelFormat format = PixelFormat::mjpeg;
  std::span<const std::uint8_t> bytes;  ///< valid until the camera is asked for the next image
  int width_px = 0;
  int height_px = 0;
  int bytes_per_line = 0;      ///< of raw formats, padding included; 0: none
  double time_s = 0;           ///< of the exposure, on the kernel's monotonic clock
  std::uint32_t sequence = 0;  ///< the driver's count, images it lost included
  bool is_key = true;          ///< can be decoded without those before it
};

/// What a camera was set to.
struct CameraDescription {
  std::string name;    ///< as the device calls itself
  std::string device;  ///< for messages, such as /dev/video0
  PixelFormat format = PixelFormat::mjpeg;
  int width_px = 0;
  int height_px = 0;
  double fps = 0;                                   ///< nominal, > 0
  std::optional<VideoHeader> video = std::nullopt;  ///< of PixelFormat::video
};

/// What went wrong on the way and was got over.
struct CameraCounts {
  int lost = 0;           ///< gaps in the driver's count
  int damaged = 0;        ///< images that the driver marked as faulty, skipped
  int reconnections = 0;  ///< times the device went away and came back
};

/// A device that delivers images at its own pace. Used from one thread.
class Camera {
 public:
  virtual ~Camera() = default;

  /// The next image; nothing when none came within `timeout`. Throws core::Error (run_failed)
  /// when the device is gone and does not come back.
  virtual std::optional<CameraBuffer> next(std::chrono::milliseconds timeout) = 0;

  [[nodiscard]] virtual CameraDescription description() const = 0;
  [[nodiscard]] virtual CameraCounts counts() const = 0;
};

}  // namespace sheen::capture
