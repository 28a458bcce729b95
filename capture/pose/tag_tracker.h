// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board.h"
#include "capture/pose/edge_search.h"
#include "capture/pose/tag_family.h"
#include "capture/pose/tag_view.h"
#include "core/geometry/camera.h"

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include <optional>
#include <vector>

namespace sheen::capture {

/// A corner of a black square: where the measured edges of its two sides meet.
struct MeasuredCorner {
  int tag_id = 0;
  int corner = 0;               ///< in Board::Tag's order
  Eigen::Vector2d px;           ///< pixel (0, 0) is the first pixel's centre
  Eigen::Vector2d residual_px;  ///< against the pose
};

/// Pose from the edges of all tags, with what speaks for it.
struct TrackedPose {
  Eigen::Isometry3d camera_from_board = Eigen::Isometry3d::Identity();
  Twist readout_motion = Twist::Zero();  ///< of a rolling shutter
  int tags = 0;                          ///< tags whose code was read and that fit the pose
  double reprojection_px = 0;            ///< root mean square over the corners of those tags
  double blur_px = 0;                    ///< as `tag_edge_width` measures it
};

/// What is known before of the motion while the rows of a rolling shutter are read.
struct ExpectedReadout {
  Twist motion = Twist::Zero();  ///< capture/pose/rolling_shutter.h
  double deviation_px = 1;       ///< how far off that may be, in the image, > 0
};

/// Follows a board whose place is roughly known: searches the edges of its tags near their
/// predicted places, reads their codes and aligns one pose with all edges (docs/algorithm.md,
/// section 10). Tags that come into view are found by the same prediction. Keeps its buffers; one
/// thread at a time.
class TagTracker {
 public:
  TagTracker(const Board& board, const core::CameraModel& camera, const TagFamily& family);

  /// No value when no pose near `predicted` explains the CV_8UC1 image; edges are found up to one
  /// and a half modules away. Rows are taken as read at once unless the motion of a readout is
  /// expected: it is estimated, too, near what is expected.
  std::optional<TrackedPose> track(const cv::Mat& grey, const Eigen::Isometry3d& predicted,
                                   const std::optional<ExpectedReadout>& expected = std::nullopt);

  /// Corners measured by the last successful `track`; cut or covered ones are missing.
  [[nodiscard]] const std::vector<MeasuredCorner>& corners() const { return corners_; }

 private:
  /// Where the board is at the middle of the readout, and how it goes on.
  struct State {
    Eigen::Isometry3d camera_from_board;
    Twist readout_motion;
  };

  [[nodiscard]] std::optional<TagView> view_of(const BoardTag& tag, const State& state) const;
  void look(const State& state);
  void look_again(const State& state);
  bool approach(const cv::Mat& grey, const std::optional<ExpectedReadout>& expected, State& state);
  bool align(const cv::Mat& grey, const std::optional<ExpectedReadout>& expected, State& state);
  std::optional<EdgeAlignment> improve(double scale_px,
                                       const std::optional<ExpectedReadout>& expected,
                                       State& state);
  [[nodiscard]] ReadoutMotionPrior prior_of(const ExpectedReadout& expected,
                                            const State& state) const;
  void measure_corners(const State& state);
  int drop_misfits();

  core::CameraModel camera_;
  std::vector<BoardTag> tags_;
  std::vector<TagView> views_;
  EdgeSearch search_;
  std::vector<MeasuredCorner> corners_;
  std::vector<double> room_;
};

}  // namespace sheen::capture
