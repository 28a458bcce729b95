// SPDX-License-Identifier: MIT
#include "exporters/viewer/first_view.h"

#include "core/geometry/tangent_frame.h"
#include "core/mesh/bounds.h"
#include "exporters/upright.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sheen::exporters::viewer {
namespace {

constexpr int kRing = 16;
constexpr std::size_t kPatchesAsked = 2000;
constexpr float kLeastCosine = 0.2f;  // what is seen at a slant counts little
constexpr float kDistance = 2;        // of the eye, in diagonals of the object: all of it is seen
constexpr float kClearlyBetter = 0.02f;

Eigen::Vector3d direction(const std::string& up, double azimuth, double elevation) {
  const Eigen::Vector3d z = y_up_from_object(up).row(1).transpose().cast<double>();
  const Eigen::Vector3d x = z.x() == 0 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  return std::cos(elevation) * (std::cos(azimuth) * x + std::sin(azimuth) * z.cross(x)) +
         std::sin(elevation) * z;
}

/// Share of the surface turned to an eye whose direction has been looked from, or nearly.
float supported_from(const core::Mesh& mesh, const fitting::SeenDirections& seen,
                     const Eigen::Vector3f& eye) {
  const std::size_t step = std::max<std::size_t>(1, seen.size() / kPatchesAsked);
  float facing = 0;
  float supported = 0;
  for (std::size_t i = 0; i < seen.size(); i += step) {
    const auto [uv, cosine] =
        core::direction_towards(core::tangent_frame(mesh.normals[i]), mesh.positions[i], eye);
    if (cosine < kLeastCosine) continue;
    facing += cosine;
    const auto cell = fitting::guidance::cell_bit(fitting::guidance::cell_of(uv));
    if ((fitting::guidance::dilated(seen[i]) & cell) != 0) supported += cosine;
  }
  return facing > 0 ? supported / facing : 1;
}

}  // namespace

FirstView first_view(const core::Mesh& mesh, const fitting::SeenDirections& seen,
                     const std::string& up) {
  const FirstView usual;
  FirstView first = usual;
  const Eigen::AlignedBox3f box = core::bounds_of(mesh);
  float best = -1;
  for (const double elevation : {usual.elevation_rad, 0.25, 0.75, 1.0}) {
    for (int i = 0; i < kRing; ++i) {
      const double azimuth = usual.azimuth_rad + 2 * i * std::numbers::pi / kRing;
      const Eigen::Vector3d towards = direction(up, azimuth, elevation);
      const Eigen::Vector3f eye =
          box.center() + kDistance * box.diagonal().norm() * towards.cast<float>();
      const float supported = supported_from(mesh, seen, eye);
      // What comes first is kept where it is about as good.
      if (supported <= best + kClearlyBetter) continue;
      best = supported;
      first = {azimuth, elevation, towards};
    }
  }
  return first;
}

}  // namespace sheen::exporters::viewer
