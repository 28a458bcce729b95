// SPDX-License-Identifier: MIT
#include "fitting/billboard/frame.h"

#include "core/geometry/tangent_frame.h"

#include <algorithm>
#include <limits>

namespace sheen::fitting::billboard {
namespace {

/// The corner that is farthest from a point.
Eigen::Vector3f farthest_corner(const core::Mesh& mesh, const Eigen::Vector3f& from) {
  Eigen::Vector3f farthest = from;
  float greatest = -1.0f;
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t vertex_idx : triangle) {
      const float squared = (mesh.positions[vertex_idx] - from).squaredNorm();
      if (squared <= greatest) continue;
      greatest = squared;
      farthest = mesh.positions[vertex_idx];
    }
  }
  return farthest;
}

}  // namespace

// Badoiu and Clarkson, "Smaller Core-Sets for Balls" (2003): the centre walks towards the farthest
// point in steps of 1 / i.
Sphere bounding_sphere(const core::Mesh& mesh) {
  constexpr int steps = 100;
  Eigen::Vector3f centre = farthest_corner(mesh, Eigen::Vector3f::Zero());
  for (int i = 1; i <= steps; ++i) {
    centre += (farthest_corner(mesh, centre) - centre) / static_cast<float>(i + 1);
  }
  const float radius_m = (farthest_corner(mesh, centre) - centre).norm();
  // Rounding must not leave the farthest corner outside.
  constexpr float slack = 1.0f + 1e-5f;
  return {centre, std::max(radius_m * slack, std::numeric_limits<float>::min())};
}

FrameCamera frame_camera(const Sphere& sphere, const Eigen::Vector3f& direction,
                         double field_of_view_deg, int side_px) {
  const core::TangentFrame frame = core::tangent_frame(direction);
  const double half_angle = field_of_view_deg / 2 * M_PI / 180;
  FrameCamera camera{sphere.centre, {}, sphere.radius_m, 0, 0, side_px};
  camera.axes << frame.tangent.transpose(), frame.bitangent.transpose(), direction.transpose();
  camera.half_m = sphere.radius_m / static_cast<float>(std::cos(half_angle));
  camera.inverse_distance = static_cast<float>(std::sin(half_angle)) / sphere.radius_m;
  return camera;
}

}  // namespace sheen::fitting::billboard
