// SPDX-License-Identifier: MIT
#include "capture/source/pixel_aspect.h"

#include "capture/source/image_check.h"
#include "core/diagnostics/error.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

namespace sheen::capture {
namespace {

constexpr double kSquare = 0.02;  // what lenses and rounded statements differ by

}  // namespace

void refuse_shown_size(const std::filesystem::path& subject, const ImageSize& stored,
                       const ImageSize& expected, double pixel_aspect) {
  const int shown_width = static_cast<int>(std::lround(stored.width_px * pixel_aspect));
  const bool is_shown_size =
      expected.height_px == stored.height_px && std::abs(expected.width_px - shown_width) <= 1;
  if (std::abs(pixel_aspect - 1) < kSquare || !is_shown_size) return;
  const double factor = static_cast<double>(stored.width_px) / expected.width_px;
  throw core::bad_input(
      subject,
      fmt::format("is stored as {}, of pixels {:.4g} times as wide as high, but the camera file is "
                  "for {}, as players show it",
                  size_text(stored), pixel_aspect, size_text(expected)),
      fmt::format("multiply fx and cx + 0.5 in that file by {:.6g} and write the stored width; or "
                  "calibrate from this camera's videos",
                  factor));
}

std::string aspect_doubt(double pixel_aspect, std::optional<double> focal_ratio) {
  if (!focal_ratio || std::abs(pixel_aspect - 1) < kSquare) return {};
  const double off_stated = std::abs(std::log(*focal_ratio / pixel_aspect));
  if (off_stated < std::abs(std::log(*focal_ratio))) return {};
  return fmt::format(
      "states pixels {0:.4g} times as wide as high, but fy / fx of the camera file is {1:.4g}, as "
      "of square ones; unless that file was made from the stored pixels of this camera, divide its "
      "fx and its cx + 0.5 by {0:.4g}",
      pixel_aspect, *focal_ratio);
}

}  // namespace sheen::capture
