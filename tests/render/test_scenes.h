// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"
#include "core/mesh/mesh.h"
#include "fitting/iwls/light_field_model.h"
#include "fitting/mean/mean_light_field.h"

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include <cstdint>
#include <string>

namespace sheen::render::testing {

/// Regular tetrahedron, corners at distance `radius_m` from the origin: coarsest closed mesh.
core::Mesh tetrahedron(float radius_m);

/// Sphere of `rings` x `2 * rings` quads, cut in two; 2 * rings * (rings - 1) + 2 vertices.
core::Mesh sphere(float radius_m, int rings);

/// Tube around a (2, 3) torus knot, about `size_m` wide: hides much of itself.
core::Mesh torus_knot(float size_m, int along, int around);

/// Sets normals to the area-weighted mean of the triangles around each vertex.
void compute_normals(core::Mesh& mesh);

/// Camera at `distance_m` from the origin, looking at it from a direction; no roll.
Eigen::Isometry3d looking_at_origin(const Eigen::Vector3d& from_direction, double distance_m);

/// No distortion; about 43 degrees wide.
core::CameraModel plain_camera(int width_px, int height_px);

/// Same with barrel distortion, tangential terms and an off-centre principal point: bends the
/// border by several percent of the image's width.
core::CameraModel distorted_camera(int width_px, int height_px);

/// Coefficients from a fixed seed: constants in [0.1, 0.9], the others in [-0.3, 0.3]; every
/// `unseen_every`-th patch unobserved (0: none).
fitting::iwls::LightFieldModel random_iwls(fitting::iwls::Layout layout, int centers, int terms,
                                           std::size_t patch_count, int unseen_every);
fitting::mean::MeanLightField random_mean(std::size_t patch_count, int unseen_every);

/// A smooth glossy look: brightness and hue follow position and direction.
fitting::iwls::LightFieldModel smooth_iwls(const core::Mesh& mesh, int centers, int terms);

/// How far two images are apart where `mask` is set, in steps of 1/255 over all channels.
struct Difference {
  double mean = 0;
  double quantile_999 = 0;
  int largest = 0;
  std::size_t pixels = 0;
};
Difference difference(const cv::Mat& a, const cv::Mat& b, const cv::Mat& mask);

/// Both masks set, eroded by `pixels`.
cv::Mat common_interior(const cv::Mat& a, const cv::Mat& b, int pixels);

}  // namespace sheen::render::testing
