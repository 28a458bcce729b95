// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/light/light_leveller.h"
#include "pipeline/row_rectifier.h"

namespace sheen::pipeline {

/// Makes of a frame the image that a camera with a global shutter and a steady exposure would have
/// taken, as far as the session needs it: whatever comes after knows one pose and one light a
/// frame. Whoever reads a frame again gets the same image again.
class FrameCorrections {
 public:
  /// As RowRectifier.
  FrameCorrections(const capture::Session& session, const core::Mesh* mesh, int threads)
      : rectifier_(session, mesh, threads), leveller_(session) {}

  /// The frame itself where nothing is to be corrected, else without luma (Frame::grey).
  capture::Frame correct(const capture::Frame& frame, const Eigen::Isometry3d& camera_from_board,
                         const capture::Twist& readout_motion);

 private:
  RowRectifier rectifier_;
  LightLeveller leveller_;
};

}  // namespace sheen::pipeline
