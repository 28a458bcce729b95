// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board.h"
#include "capture/source/frame_range.h"
#include "core/geometry/camera.h"

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include <memory>
#include <optional>
#include <variant>
#include <vector>

namespace sheen::capture {

/// A printed chessboard, by its inner corners.
struct Chessboard {
  int columns = 9;          ///< inner corners, >= 3
  int rows = 6;             ///< inner corners, >= 3
  double square_m = 0.025;  ///< side of a square, > 0
};

using CalibrationTarget = std::variant<Board, Chessboard>;

/// Points of a target as one image shows them. Both lists have the same length.
struct TargetView {
  int frame_index = 0;
  std::vector<Eigen::Vector3d> on_target;  ///< metres
  std::vector<Eigen::Vector2d> in_image;   ///< px
};

/// Finds the points of one target. Move-only; one thread at a time.
class TargetFinder {
 public:
  virtual ~TargetFinder() = default;

  /// The points in a CV_8UC1 image; nothing when too few are seen to say anything.
  virtual std::optional<TargetView> find(const cv::Mat& grey) = 0;

  /// Measures the points of `view` in its image once more, now that the lens is known: straight
  /// lines of the print are bent by it.
  virtual void refine(const cv::Mat& grey, const core::CameraModel& camera,
                      TargetView& view) const = 0;
};

/// Some lens between a phone's and a webcam's, until one is known.
core::CameraModel plain_camera(const ImageSize& size);

/// Throws std::invalid_argument for a target that cannot be found: too few corners, unknown family.
std::unique_ptr<TargetFinder> make_target_finder(const CalibrationTarget& target);

}  // namespace sheen::capture
