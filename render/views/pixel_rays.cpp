// SPDX-License-Identifier: MIT
#include "render/views/pixel_rays.h"

#include "core/concurrency/parallel_for.h"

#include <limits>

namespace sheen::render {

void PixelRays::set_camera(const core::CameraModel& camera) {
  if (camera.intrinsics() == camera_.intrinsics()) return;
  camera_ = camera;
  const auto width = static_cast<std::size_t>(camera.width_px());
  const std::size_t count = width * static_cast<std::size_t>(camera.height_px());
  constexpr float none = std::numeric_limits<float>::quiet_NaN();
  x_.assign(count, none);
  y_.assign(count, none);
  core::parallel_for(count, threads_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto ray =
          camera.unproject({static_cast<double>(i % width), static_cast<double>(i / width)});
      if (!ray) continue;
      x_[i] = static_cast<float>(ray->x());
      y_[i] = static_cast<float>(ray->y());
    }
  });
}

}  // namespace sheen::render
