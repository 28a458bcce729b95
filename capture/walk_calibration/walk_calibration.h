// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board.h"
#include "capture/pose/tag_detector.h"
#include "capture/walk_calibration/lens_prior.h"
#include "core/geometry/camera.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sheen::capture {

/// A camera as the tags seen on a walk say it is, with how surely they say so.
struct WalkCalibration {
  /// One number of the lens: px, or OpenCV's distortion. "edges" is of the images: px by which
  /// black squares look larger at each side, since codes are not light and ink spreads.
  struct Number {
    std::string_view name;
    double value = 0;
    double sigma = 0;  ///< standard deviation; of one that is not kept: what the images leave open
    double prior = 0;
    bool is_kept = false;  ///< told from the prior by the images; else value == prior
  };
  core::CameraModel camera;
  std::vector<Number> numbers;  ///< focal, edges, k1, cx, cy, k2, aspect, p1, p2
  double height_sigma = 0;      ///< of heights above the sheet, relative
  double distance_sigma = 0;    ///< of the camera's distance from the sheet, relative
  double rms_px = 0;            ///< over the corners that took part
  int views = 0;
};

/// Focal length, principal point and distortion from a board's tags in at least kFewestWalkViews
/// images, by bundle adjustment over lens and poses (Huber loss). The focal length is always
/// estimated. Edges, k1, principal point, k2, aspect and decentring are tried in this order, and
/// stay at their priors (zero, the image's centre, the pixels' aspect as stated) unless they differ
/// from them by three standard deviations. Deviations are the larger of those from the residuals
/// and of those from how views disagree, corners of one image being wrong together. Nothing when
/// too few views show two tags or no lens fits.
std::optional<WalkCalibration> calibrate_from_walk(
    const Board& board, const LensPrior& prior,
    const std::vector<std::vector<TagDetection>>& views);

inline constexpr std::size_t kFewestWalkViews = 6;

/// Why a calibration cannot be believed; empty: it can.
std::string find_fault(const WalkCalibration& calibration);

}  // namespace sheen::capture
