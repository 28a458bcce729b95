// SPDX-License-Identifier: MIT
#include "pipeline/frame_corrections.h"

namespace sheen::pipeline {

capture::Frame FrameCorrections::correct(const capture::Frame& frame,
                                         const Eigen::Isometry3d& camera_from_board,
                                         const capture::Twist& readout_motion) {
  capture::Frame corrected = rectifier_.rectify(frame, camera_from_board, readout_motion);
  const cv::Mat levelled = leveller_.level(corrected.image, camera_from_board);
  if (levelled.data != corrected.image.data) {
    corrected.image = levelled;
    corrected.grey.release();
  }
  return corrected;
}

}  // namespace sheen::pipeline
