// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/edge_alignment.h"
#include "capture/source/frame.h"

#include <Eigen/Geometry>

#include <optional>

namespace sheen::capture {

/// Where a camera will be if it goes on as it went between the last two poses.
class MotionPrediction {
 public:
  /// A frame and its pose, in the order of the recording.
  void note(const Frame& frame, const Eigen::Isometry3d& camera_from_board);

  /// The pose noted last: where the camera is if it has stopped.
  [[nodiscard]] std::optional<Eigen::Isometry3d> last() const;

  /// How the board moved between the last two poses, a twist per second in the camera frame; no
  /// value when they are not known, or not when they were taken.
  [[nodiscard]] std::optional<Twist> velocity() const;

  /// camera_from_board, its rotation orthonormal; no value when no pose is known.
  [[nodiscard]] std::optional<Eigen::Isometry3d> predict(const Frame& frame) const;

 private:
  struct Known {
    double time_s = 0;
    int index = 0;
    Eigen::Isometry3d camera_from_board = Eigen::Isometry3d::Identity();
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();  ///< from the pose before to this
    double interval_s = 0;                                     ///< it took, 0 when unknown
    int frames = 1;                                            ///< it took
  };
  std::optional<Known> last_;
};

}  // namespace sheen::capture
