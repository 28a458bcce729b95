// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/paper_light.h"
#include "capture/session/session.h"

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include <map>
#include <optional>

namespace sheen::pipeline {

/// Takes the exposure of frames out (docs/algorithm.md, 14): divides their light by what the paper
/// around the tags says of it. What is saturated stays so in its shade.
class LightLeveller {
 public:
  /// Does nothing for a session without `paper_light`.
  explicit LightLeveller(const capture::Session& session);

  /// The image itself, untouched, where too few tags are seen. `image` is CV_8UC3, BGR, of one
  /// pose.
  [[nodiscard]] cv::Mat level(const cv::Mat& image,
                              const Eigen::Isometry3d& camera_from_board) const;

 private:
  std::map<int, Eigen::Vector3d> usual_;
  std::optional<capture::PaperReader> reader_;  ///< where there is something to level
};

}  // namespace sheen::pipeline
