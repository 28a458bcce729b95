// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"
#include "core/mesh/mesh.h"

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include <optional>
#include <vector>

namespace sheen::capture {

/// An image whose camera is known.
struct RegistrationView {
  cv::Mat image;  ///< CV_8UC3, BGR
  Eigen::Isometry3d camera_from_board = Eigen::Isometry3d::Identity();
  double weight = 1;  ///< trust in image and pose, > 0
};

/// Where an object stands on the board, as its outline in many images says.
struct Registration {
  Eigen::Isometry3d board_from_object = Eigen::Isometry3d::Identity();
  double residual_px = 0;    ///< median distance of the outline from the images' edges
  double matched_share = 0;  ///< of the outline that has an edge within 2 px, [0, 1]
  double motion_px = 0;      ///< mean distance by which the outline moved from the guess
  double translation_m = 0;  ///< how far the object's centre moved from the guess
  double rotation_rad = 0;   ///< how far it turned
  double sigma_m = 0;        ///< standard deviation of the centre, in its worst direction
  double sigma_rad = 0;      ///< of the rotation, about its worst axis
  std::size_t points = 0;    ///< of the outline that were matched
  int views = 0;             ///< images that agree with the others
  std::vector<bool> agrees;  ///< which, by view
};

/// How far the guess may be off.
struct RegistrationLimits {
  double search_m = 0.02;           ///< expected error of the outline at the guess, metres, > 0
  double min_matched_share = 0.25;  ///< less of the outline with an edge is no answer
};

/// Moves the object until its silhouette and depth edges lie on edges of the images: Gauss-Newton
/// with robust weights over all views, first on where the object's colours end (learned from the
/// images themselves; from afar), then on edges (to a fraction of a pixel), the search
/// distance falling from step to step. The uncertainty comes from the disagreement of the views.
/// Nothing when too little of the outline finds an edge. One thread: the result is always the same.
std::optional<Registration> register_object(const core::Mesh& mesh, const core::CameraModel& camera,
                                            const std::vector<RegistrationView>& views,
                                            const Eigen::Isometry3d& guess,
                                            const RegistrationLimits& limits);

}  // namespace sheen::capture
