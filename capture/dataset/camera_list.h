// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"

#include <array>
#include <cstddef>
#include <map>
#include <vector>

namespace sheen::capture {

/// Cameras that a file repeats for each of its images, each kept once.
class CameraList {
 public:
  /// Index of `camera` in `cameras`, which only this list adds to.
  std::size_t add(const core::CameraModel& camera, std::vector<core::CameraModel>& cameras);

 private:
  std::map<std::array<double, 15>, std::size_t> index_;  ///< by all numbers of a camera
};

}  // namespace sheen::capture
