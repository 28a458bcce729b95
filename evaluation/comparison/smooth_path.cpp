// SPDX-License-Identifier: MIT
#include "evaluation/comparison/smooth_path.h"

#include <opencv2/core.hpp>

#include <algorithm>
#include <cmath>

namespace sheen::evaluation {
namespace {

constexpr int kSteps = 64;
constexpr double kStep_deg = 0.25;
constexpr double kWidest_px = 320;

core::CameraModel at_most_wide(const core::CameraModel& camera) {
  core::CameraModel::Intrinsics in = camera.intrinsics();
  const double scale = std::min(1.0, kWidest_px / in.width_px);
  in.width_px = std::max(1, static_cast<int>(std::lround(in.width_px * scale)));
  in.height_px = std::max(1, static_cast<int>(std::lround(in.height_px * scale)));
  in.focal_px *= scale;
  // A pixel's middle has whole coordinates, its border does not.
  in.principal_px = ((in.principal_px.array() + 0.5) * scale - 0.5).matrix();
  return core::CameraModel(in);
}

double change(const render::RenderedView& a, const render::RenderedView& b) {
  const cv::Mat either = a.mask | b.mask;
  const int pixels = cv::countNonZero(either);
  if (pixels == 0) return 0;
  return cv::norm(a.image, b.image, cv::NORM_L2, either) / std::sqrt(3.0 * pixels);
}

}  // namespace

SmoothPath smooth_path(const core::CameraModel& camera, const Eigen::Isometry3d& pose,
                       const Eigen::Vector3d& centre, const Eigen::Vector3d& axis) {
  SmoothPath path{at_most_wide(camera), {}};
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = (i - kSteps / 2.0) * kStep_deg * M_PI / 180;
    path.camera_from_object.push_back(pose * Eigen::Translation3d(centre) *
                                      Eigen::AngleAxisd(angle, axis) *
                                      Eigen::Translation3d(-centre));
  }
  return path;
}

double pop_ratio(render::Renderer& renderer, const SmoothPath& path) {
  std::vector<double> changes;
  render::RenderedView before;
  for (const Eigen::Isometry3d& pose : path.camera_from_object) {
    render::RenderedView now = renderer.render(path.camera, pose);
    if (!before.image.empty()) changes.push_back(change(before, now));
    before = std::move(now);
  }
  std::ranges::sort(changes);
  const double median = changes[changes.size() / 2];
  return median > 0 ? changes.back() / median : 1;
}

}  // namespace sheen::evaluation
