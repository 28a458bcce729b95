// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/camera.h"
#include "capture/source/frame_range.h"
#include "capture/source/v4l2_device.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace sheen::capture {

/// One way in which a camera can work.
struct CameraMode {
  PixelFormat format = PixelFormat::mjpeg;
  ImageSize size;
  double fps = 0;  ///< 0 where the driver does not say

  friend bool operator==(const CameraMode& a, const CameraMode& b) {
    return a.format == b.format && a.size.width_px == b.size.width_px &&
           a.size.height_px == b.size.height_px && a.fps == b.fps;
  }
};

/// What the user asks for; what is left open is chosen.
struct ModeWish {
  std::optional<PixelFormat> format;
  std::optional<ImageSize> size;  ///< else 1280x720 or the nearest to it
  std::optional<double> fps;      ///< > 0; else the largest
};

/// The kernel's code of a format, and back; nothing for formats that are not read here.
[[nodiscard]] std::uint32_t fourcc(PixelFormat format);
[[nodiscard]] std::optional<PixelFormat> pixel_format(std::uint32_t fourcc);
/// "MJPG", "YUYV" or "NV12".
[[nodiscard]] std::string format_name(PixelFormat format);

/// Every mode in a format that can be read. Ranges of sizes become the common sizes within them.
[[nodiscard]] std::vector<CameraMode> camera_modes(const V4l2Device& device);

/// The mode nearest to the wish: the format and size as asked, then the rate as asked or the
/// largest, then the fewest bytes (MJPEG before NV12 before YUYV). Nothing when no mode has the
/// asked format or size.
[[nodiscard]] std::optional<CameraMode> choose_mode(const std::vector<CameraMode>& modes,
                                                    const ModeWish& wish);

/// What a driver says after it was set.
struct ActiveMode {
  CameraMode mode;              ///< fps as the driver reports it, 0 when it does not say
  int bytes_per_line = 0;       ///< of raw formats; 0 for MJPEG
  std::size_t least_bytes = 0;  ///< of a whole image; 0 for MJPEG
};

/// Sets the mode. Throws V4l2Error when the driver refuses or sets something else.
[[nodiscard]] ActiveMode set_mode(const V4l2Device& device, const CameraMode& mode);

}  // namespace sheen::capture
