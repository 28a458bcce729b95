// SPDX-License-Identifier: MIT
#include "reconstruction/views/projection.h"

namespace sheen::reconstruction {

Projection::Projection(const core::CameraModel& camera, const Eigen::Isometry3d& camera_from_board)
    : turn_(camera_from_board.linear().cast<float>()),
      shift_(camera_from_board.translation().cast<float>()),
      eye_(camera_from_board.inverse().translation().cast<float>()),
      focal_px_(camera.intrinsics().focal_px.cast<float>()),
      principal_px_(camera.intrinsics().principal_px.cast<float>()),
      lens_(camera.intrinsics().lens),
      largest_r2_(static_cast<float>(camera.valid_radius() * camera.valid_radius())),
      mean_focal_px_(0.5F * focal_px_.sum()),
      width_px_(camera.width_px()),
      height_px_(camera.height_px()) {
  for (std::size_t i = 0; i < k_.size(); ++i) {
    k_[i] = static_cast<float>(camera.intrinsics().distortion[i]);
  }
}

}  // namespace sheen::reconstruction
