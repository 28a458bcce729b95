// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/edge_alignment.h"
#include "core/samples/vertex_view.h"
#include "fitting/confidence/confidence.h"

#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace sheen::pipeline {

/// A frame that got a pose.
struct PosedFrame {
  int index = 0;
  double time_s = 0;
  Eigen::Isometry3d camera_from_board = Eigen::Isometry3d::Identity();
  capture::Twist readout_motion = capture::Twist::Zero();  ///< of a rolling shutter
};

struct TrackedFrame;

/// Everything that is counted while frames arrive.
struct FrameStatistics {
  int frames_read = 0;
  int damaged = 0;  ///< frames that came damaged and were left out; not among those read
  int first_index = 0, last_index = 0;  ///< of the frames read
  double first_s = 0, last_s = 0;       ///< their times
  int frames_fitted = 0;
  int frames_refused = 0;                      ///< posed, but not admitted to the model
  std::vector<PosedFrame> posed;               ///< in recorded order, held-out ones included
  std::vector<PosedFrame> held_out;            ///< posed, kept out of the fit
  std::map<std::string, int> pose_rejections;  ///< by name of PoseRejection
  std::array<std::size_t, core::kVertexRejectionCount> vertex_rejections{};
  /// From where each patch was looked at by the frames that were fitted. Views that are taken back
  /// later still count.
  fitting::SeenDirections seen;
  std::vector<double> reprojection_px;  ///< of frames posed from tags
  std::vector<double> refined_px;       ///< mean motion of every frame whose pose was refined
  std::vector<double> gains;            ///< exposure of every frame that told it

  /// Counts a frame as read, and why it has no pose if it has none.
  std::optional<PosedFrame> count(const TrackedFrame& tracked);
};

}  // namespace sheen::pipeline
