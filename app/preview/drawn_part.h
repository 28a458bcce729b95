// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"
#include "render/gl/functions.h"

#include <Eigen/Geometry>
#include <imgui.h>

namespace sheen::app {

/// Part of a camera's image that something inside `box` (object frame) can appear in, in shares
/// of width and height: all of [0, 1] when the box reaches behind the camera. The rest need not be
/// put on the screen.
Eigen::AlignedBox2f drawn_part(const Eigen::AlignedBox3d& box, const core::CameraModel& camera,
                               const Eigen::Isometry3d& camera_from_object);

/// Puts that part of a texture, stretched over a rectangle as a whole, into the rectangle.
void add_part(ImDrawList& list, GLuint texture, const ImVec2& corner, const ImVec2& size,
              const Eigen::AlignedBox2f& part, float strength = 1);

}  // namespace sheen::app
