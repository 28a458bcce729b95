// SPDX-License-Identifier: MIT
#pragma once

#include "capture/registration/registration.h"

#include <string>
#include <vector>

namespace sheen::capture {

/// Images of some views, cut to the object, with its outline at `before` (orange) and at `after`
/// (blue; the only one where both are the same): where blue lies on the object's edge, it stands
/// where it was photographed. CV_8UC3. `labels` has one text per view.
cv::Mat draw_registration(const core::Mesh& mesh, const core::CameraModel& camera,
                          const std::vector<RegistrationView>& views,
                          const std::vector<std::string>& labels, const Eigen::Isometry3d& before,
                          const Eigen::Isometry3d& after);

}  // namespace sheen::capture
