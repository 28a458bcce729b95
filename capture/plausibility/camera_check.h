// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"

#include <string>
#include <vector>

namespace sheen::capture {

/// What hardly any camera has, and what may have gone wrong in its file: exchanged coordinates of
/// the principal point, coefficients in another order. One line each.
std::vector<std::string> check_camera(const core::CameraModel& camera);

}  // namespace sheen::capture
