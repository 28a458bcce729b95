// SPDX-License-Identifier: MIT
#include "core/visibility/distorted_edges.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace sheen::core {
namespace {

constexpr double kStraight_px = 0.25;
/// Longest edge by distance of a triangle that may have corners without pixels: the lens model
/// ends farther outside the image than that.
constexpr double kSmall = 0.1;

bool is_small(const std::array<Eigen::Vector3d, 3>& in_camera) {
  double longest_m = 0;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    longest_m = std::max(longest_m, (in_camera[i] - in_camera[(i + 1) % 3]).norm());
    nearest_m = std::min(nearest_m, in_camera[i].norm());
  }
  return longest_m < kSmall * nearest_m;
}

double distance_to_line(const Eigen::Vector2d& point, const Eigen::Vector2d& a,
                        const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = b - a;
  const Eigen::Vector2d to_point = point - a;
  const double length = along.norm();
  if (length == 0) return to_point.norm();
  return std::abs(along.x() * to_point.y() - along.y() * to_point.x()) / length;
}

}  // namespace

bool has_distorted_edge(const CameraModel& camera, const Eigen::Isometry3d& camera_from_object,
                        const std::array<Eigen::Vector3f, 3>& corners) {
  std::array<Eigen::Vector3d, 3> in_camera;
  std::array<std::optional<Eigen::Vector2d>, 3> pixels;
  for (std::size_t i = 0; i < 3; ++i) {
    in_camera[i] = camera_from_object * corners[i].cast<double>();
    pixels[i] = camera.project(in_camera[i]);
  }
  if (!(pixels[0] && pixels[1] && pixels[2])) return !is_small(in_camera);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const auto middle = camera.project((in_camera[i] + in_camera[j]) / 2);
    if (!middle || distance_to_line(*middle, *pixels[i], *pixels[j]) > kStraight_px) return true;
  }
  return false;
}

}  // namespace sheen::core
