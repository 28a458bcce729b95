// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <optional>
#include <vector>

namespace sheen::capture {

using Twist = Eigen::Matrix<double, 6, 1>;  ///< rotation vector (rad), then translation (m)

/// Where an edge of the print was found, against where the present pose puts it.
struct EdgeObservation {
  Twist outward_by_twist;  ///< how far the edge moves out of its tag with the board, px
  double offset_px = 0;    ///< found this far outwards
  double row_share = 0;    ///< when its row is read (capture/pose/rolling_shutter.h)
};

/// What is expected of the board's motion while a frame's rows are read.
struct ReadoutMotionPrior {
  Twist mean = Twist::Zero();
  Twist precision = Twist::Zero();  ///< what a deviation costs: squared residuals, px^2, over its
                                    ///< square
};

/// Small motion of the board in the camera frame, and what is left.
struct EdgeAlignment {
  Twist twist = Twist::Zero();
  Twist readout_motion = Twist::Zero();  ///< zero without a prior
  double swell_px = 0;  ///< by which all edges lie outwards alike: exposure, ink, blur
  double moved_px = 0;  ///< median of how far the twist moves the edges
};

/// Robust least squares over edges (docs/algorithm.md, (20)). With a prior the motion during the
/// readout is estimated, too, as a change of what the observations were predicted with. `scratch`
/// is scratch space. No value when the observations do not determine a pose.
std::optional<EdgeAlignment> align_edges(
    const std::vector<EdgeObservation>& observations, double finest_scale_px,
    std::vector<double>& scratch, const std::optional<ReadoutMotionPrior>& prior = std::nullopt);

/// exp(twist) * camera_from_board, its rotation orthonormal.
Eigen::Isometry3d moved(const Eigen::Isometry3d& camera_from_board, const Twist& twist);

}  // namespace sheen::capture
