// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/guidance/view_utility.h"

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace sheen::app {

/// What a running pipeline shows of itself. A copy: nothing in it changes any more.
struct LiveStatus {
  enum class Phase { running, paused, undoing, finished };
  Phase phase = Phase::running;

  int frames_read = 0;
  int frames_fitted = 0;
  int frames_undone = 0;
  std::vector<std::pair<std::string, int>> refusals;  ///< reason in words, frames; most first
  std::string trouble;  ///< why the last frame was refused; empty when it was not
  std::vector<std::pair<std::string, double>> stage_ms;  ///< CPU per frame, median of the last ones

  cv::Mat image;  ///< last frame, CV_8UC3 BGR; shared, never written to
  std::optional<Eigen::Isometry3d> camera_from_object;  ///< of that frame

  double coverage = 0;                  ///< [0, 1]
  std::vector<float> psnr_db;           ///< prediction of every frame before it was integrated
  bool is_flat = false;                 ///< going on as before brings little
  std::optional<Eigen::Vector3d> hint;  ///< where to stand next, object frame, metres

  std::string note;  ///< outcome of the last request, e.g. "saved model.glb"
};

}  // namespace sheen::app
