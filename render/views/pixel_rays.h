// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"

#include <span>
#include <vector>

namespace sheen::render {

/// The ray of every pixel of a camera, lens included, where it meets the plane z = 1; NaN where the
/// lens model has none. Remembers the last camera.
class PixelRays {
 public:
  explicit PixelRays(int threads) : threads_(threads) {}

  void set_camera(const core::CameraModel& camera);

  /// Of one row of pixels.
  [[nodiscard]] std::span<const float> x(int row) const { return of(x_, row); }
  [[nodiscard]] std::span<const float> y(int row) const { return of(y_, row); }

 private:
  [[nodiscard]] std::span<const float> of(const std::vector<float>& values, int row) const {
    const auto width = static_cast<std::size_t>(camera_.width_px());
    return std::span(values).subspan(static_cast<std::size_t>(row) * width, width);
  }

  int threads_;
  core::CameraModel camera_;
  std::vector<float> x_, y_;
};

}  // namespace sheen::render
