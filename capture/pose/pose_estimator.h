// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board.h"
#include "capture/pose/edge_alignment.h"
#include "capture/pose/trajectory.h"
#include "capture/source/frame.h"
#include "core/geometry/camera.h"

#include <Eigen/Geometry>

#include <memory>
#include <string_view>
#include <variant>

namespace sheen::capture {

/// Why a frame got no pose. The names appear in reports.
enum class PoseRejection { no_tags, too_few_tags, reprojection, blur, no_pose_in_file };
std::string_view name_of(PoseRejection rejection);

/// Pose of the camera for one frame, with what speaks for it.
struct FramePose {
  Eigen::Isometry3d camera_from_board = Eigen::Isometry3d::Identity();
  /// How the board moves from the first row to the last (capture/pose/rolling_shutter.h); the pose
  /// is that of the middle row.
  Twist readout_motion = Twist::Zero();
  int tags = 0;                ///< tags that carried the estimate; 0 for poses from a file
  double reprojection_px = 0;  ///< root mean square over the corners that carried it
  double blur_px = 0;          ///< width of the tags' edges (10-90 %), 0 for poses from a file
};

using PoseResult = std::variant<FramePose, PoseRejection>;

/// What a frame must show to be posed.
struct PoseGate {
  int min_tags = 2;                ///< fewer known tags are refused, >= 1
  double max_reprojection_px = 2;  ///< joint RMS above this is refused, px, > 0
  double max_blur_px = 4;          ///< wider tag edges are refused, px, > 0

  /// Throws std::invalid_argument naming the option and its allowed values.
  void check() const;
};

/// Frame -> pose. One estimator serves one recording in order.
class PoseEstimator {
 public:
  virtual ~PoseEstimator() = default;
  virtual PoseResult estimate(const Frame& frame) = 0;
};

/// Follows the board's tags by their edges; where the prediction fails it detects them in the whole
/// image, in the same frame. Of a camera with a rolling shutter (Intrinsics::readout_s) the motion
/// during the readout is estimated, too. Results depend on the frames alone, not on time.
std::unique_ptr<PoseEstimator> make_tag_pose_estimator(const Board& board,
                                                       const core::CameraModel& camera,
                                                       const PoseGate& gate);

/// Looks poses up in a file, those of the middle row; how the camera moves while it reads a frame
/// (`readout_s`, as Intrinsics has it) follows from the poses around.
std::unique_ptr<PoseEstimator> make_recorded_pose_estimator(Trajectory trajectory, double fps,
                                                            double readout_s = 0);

}  // namespace sheen::capture
