// SPDX-License-Identifier: MIT
#include "capture/plausibility/camera_check.h"

#include <fmt/format.h>

#include <algorithm>

namespace sheen::capture {
namespace {

constexpr double kFarFromMiddle = 0.2;    // of the image's sides; lenses have some hundredths
constexpr double kMostTangential = 0.02;  // p1 and p2; lenses have thousandths

/// Largest distance from the middle, in sides of the image.
double off_middle(const Eigen::Vector2d& point_px, const Eigen::Vector2d& size_px) {
  return ((point_px.array() + 0.5) / size_px.array() - 0.5).abs().maxCoeff();
}

}  // namespace

std::vector<std::string> check_camera(const core::CameraModel& camera) {
  const core::CameraModel::Intrinsics& lens = camera.intrinsics();
  const Eigen::Vector2d size_px(lens.width_px, lens.height_px);
  const Eigen::Vector2d& principal = lens.principal_px;
  std::vector<std::string> doubts;
  const double off = off_middle(principal, size_px);
  if (off > kFarFromMiddle) {
    const bool may_be_exchanged = off_middle(principal.reverse(), size_px) < 0.5 * off;
    doubts.push_back(fmt::format(
        "the principal point ({:.4g}, {:.4g}) lies far from the middle of {}x{} pixels; {}",
        principal.x(), principal.y(), lens.width_px, lens.height_px,
        may_be_exchanged ? "are cx and cy exchanged?" : "are the images cut out of larger ones?"));
  }
  const double tangential = std::max(std::abs(lens.distortion[2]), std::abs(lens.distortion[3]));
  if (lens.lens == core::LensKind::rational && tangential > kMostTangential) {
    doubts.push_back(
        fmt::format("the tangential distortion, {:.3g}, is larger than lenses have; is the order "
                    "of the coefficients k1 k2 p1 p2 k3?",
                    tangential));
  }
  return doubts;
}

}  // namespace sheen::capture
