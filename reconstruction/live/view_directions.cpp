// SPDX-License-Identifier: MIT
#include "reconstruction/live/view_directions.h"

#include <array>
#include <cmath>
#include <numbers>

namespace sheen::reconstruction {
namespace {

constexpr std::array kHeights_deg{8.0, 32.0, 56.0, 80.0};  // between the rings
constexpr double kDegree = std::numbers::pi / 180;
constexpr double kPlace_rad = 2 * std::numbers::pi / static_cast<double>(kViewPlaces);

}  // namespace

std::optional<std::size_t> view_direction_of(const Eigen::Vector3d& towards_eye) {
  const double height_deg = std::atan2(towards_eye.z(), towards_eye.head<2>().norm()) / kDegree;
  for (std::size_t ring = 0; ring + 1 < kHeights_deg.size(); ++ring) {
    if (!(height_deg >= kHeights_deg[ring] && height_deg < kHeights_deg[ring + 1])) continue;
    const double turn = std::atan2(towards_eye.y(), towards_eye.x()) + 2 * std::numbers::pi;
    const auto place = static_cast<std::size_t>(std::floor(turn / kPlace_rad)) % kViewPlaces;
    return ring * kViewPlaces + place;
  }
  return std::nullopt;
}

Eigen::Vector3d middle_of_direction(std::size_t direction) {
  const std::size_t ring = direction / kViewPlaces;
  const double up = kDegree * (kHeights_deg[ring] + kHeights_deg[ring + 1]) / 2;
  const double turn = kPlace_rad * (static_cast<double>(direction % kViewPlaces) + 0.5);
  return {std::cos(up) * std::cos(turn), std::cos(up) * std::sin(turn), std::sin(up)};
}

}  // namespace sheen::reconstruction
