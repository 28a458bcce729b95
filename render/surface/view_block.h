// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"

#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <string>

namespace sheen::render {

/// How far a straight edge of the mesh may deviate from the curve the lens makes of it, in pixels.
inline constexpr double kSagittaLimitPx = 0.05;

/// Uniform block `View` of shaders/view_block.glsl, std140.
struct ViewBlock {
  std::array<float, 16> camera_from_object;  ///< column-major
  std::array<float, 4> pinhole;
  std::array<float, 8> lens;
  std::array<float, 4> eye_and_near;
  std::array<float, 4> image;
  std::int32_t lens_kind;
  std::array<std::int32_t, 3> padding;
};

/// `near_m` is the depth of the near plane, `longest_segment` see below (infinity becomes a large
/// number).
ViewBlock make_view_block(const core::CameraModel& camera,
                          const Eigen::Isometry3d& camera_from_object, double near_m,
                          double longest_segment);

/// Longest straight segment, measured in the plane z = 1, that the lens bends by no more than
/// `kSagittaLimitPx` anywhere in the image; infinity without distortion. The middle of a segment
/// of length s lies about |D''| s^2 / 8 beside the image of its ends, D being the lens map.
double longest_straight_segment(const core::CameraModel& camera);

/// The block, the lenses of core/geometry/lens as GLSL reads them (`distort`), and the way from the
/// camera's frame to clip space (shaders/clip.glsl).
std::string lens_glsl();

}  // namespace sheen::render
