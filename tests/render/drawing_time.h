// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"
#include "render/renderer.h"

#include <Eigen/Geometry>

#include <ctime>

namespace sheen::tests {

/// CPU time of this process, all threads, for drawing what was drawn before; milliseconds an image.
inline double drawing_cpu_ms(render::Renderer& renderer, const core::CameraModel& camera,
                             const Eigen::Isometry3d& pose) {
  constexpr int times = 5;
  const std::clock_t before = std::clock();
  for (int i = 0; i < times; ++i) renderer.render(camera, pose);
  return 1000.0 * static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC / times;
}

}  // namespace sheen::tests
