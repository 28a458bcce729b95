// SPDX-License-Identifier: MIT
#include "render/depth_quads/camera_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace sheen::render {
namespace {

using fitting::KeptView;
using fitting::depth_quads::DepthQuads;

constexpr double kNever = std::numeric_limits<double>::infinity();

/// What is compared: the view that is drawn.
struct Viewer {
  const core::CameraModel& camera;
  const Eigen::Isometry3d& camera_from_object;
  Eigen::Vector3d eye;   ///< object frame, metres
  Eigen::Vector3d axis;  ///< direction of view, unit
};

Eigen::Vector3d axis_of(const Eigen::Isometry3d& camera_from_object) {
  return camera_from_object.linear().row(2).transpose();
}

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

bool is_seen(const Viewer& viewer, const Eigen::Vector3d& point) {
  const auto pixel = viewer.camera.project(viewer.camera_from_object * point);
  return pixel && pixel->x() >= -0.5 && pixel->y() >= -0.5 &&
         pixel->x() <= viewer.camera.width_px() - 0.5 &&
         pixel->y() <= viewer.camera.height_px() - 0.5;
}

/// The paper's rank.
double distance_from_axis(const Viewer& viewer, const KeptView& photograph) {
  const auto& in = viewer.camera.intrinsics();
  const double field =
      2 * std::atan(std::max(in.width_px / in.focal_px.x(), in.height_px / in.focal_px.y()) / 2);
  if (angle_between(axis_of(photograph.camera_from_object), viewer.axis) > field) return kNever;
  const Eigen::Vector3d offset = photograph.eye() - viewer.eye;
  return (offset - offset.dot(viewer.axis) * viewer.axis).norm();
}

/// Half the resolution counts like ten degrees.
double angle_at(const Eigen::Vector3d& middle, const Viewer& viewer, const KeptView& photograph) {
  constexpr double per_octave = 10 * M_PI / 180;
  const Eigen::Vector3d to_viewer = viewer.eye - middle;
  const Eigen::Vector3d to_photograph = photograph.eye() - middle;
  const double coarser = to_photograph.norm() / photograph.camera.intrinsics().focal_px.x() /
                         (to_viewer.norm() / viewer.camera.intrinsics().focal_px.x());
  return angle_between(to_viewer, to_photograph) +
         per_octave * std::max(0.0, std::log2(std::max(coarser, 1e-9)));
}

Eigen::Vector3d middle_of(const DepthQuads& quads) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0;
  for (std::size_t i = 0; i < quads.element_count(); ++i) {
    for (const Eigen::Vector3d& probe : quads.quads(i).probes) sum += probe;
    count += static_cast<double>(quads.quads(i).probes.size());
  }
  return sum / std::max(count, 1.0);
}

}  // namespace

std::vector<ChosenCamera> choose_cameras(const DepthQuads& quads, const core::CameraModel& camera,
                                         const Eigen::Isometry3d& camera_from_object) {
  const Viewer viewer{camera, camera_from_object, camera_from_object.inverse().translation(),
                      axis_of(camera_from_object)};
  const bool hard = quads.options().blending == fitting::depth_quads::Blending::hard;
  const Eigen::Vector3d middle = middle_of(quads);

  // Rank all that show something of what is looked at.
  std::vector<std::pair<double, std::size_t>> ranked;
  for (std::size_t i = 0; i < quads.element_count(); ++i) {
    const KeptView& photograph = quads.photographs()[i];
    const double rank =
        hard ? distance_from_axis(viewer, photograph) : angle_at(middle, viewer, photograph);
    const bool shown =
        std::ranges::any_of(quads.quads(i).probes,
                            [&](const Eigen::Vector3d& probe) { return is_seen(viewer, probe); });
    if (shown && rank < kNever) ranked.emplace_back(rank, i);
  }

  // Keep the first ones; equal ranks in the order of the photographs. A share of 1 - rank / next
  // rank (Buehler et al. 2001) lets a photograph leave without a jump.
  std::ranges::sort(ranked);
  const auto count = std::min(ranked.size(), static_cast<std::size_t>(quads.options().cameras));
  const double next = count < ranked.size() ? ranked[count].first : kNever;
  std::vector<ChosenCamera> chosen;
  for (std::size_t i = 0; i < count; ++i) {
    constexpr float least = 1e-3f;
    const auto share = static_cast<float>(1 - ranked[i].first / next);
    chosen.push_back({ranked[i].second, std::isfinite(share) ? std::max(share, least) : least});
  }
  return chosen;
}

}  // namespace sheen::render
