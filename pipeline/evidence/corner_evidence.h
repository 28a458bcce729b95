// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board.h"
#include "capture/pose/tag_tracker.h"
#include "capture/source/frame.h"
#include "core/geometry/camera.h"
#include "pipeline/evidence/finding.h"
#include "pipeline/thinned.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <optional>
#include <vector>

namespace sheen::pipeline {

/// What is left of the tags' corners when every frame has its best pose, against the patterns that
/// known faults leave there: another lens, a principal point elsewhere, a bent board, rows that are
/// read one after the other. Poses take up most of such a fault; the rest of it, projected off the
/// six freedoms of each pose, is fitted by one small linear least squares over all frames per
/// fault.
class CornerEvidence {
 public:
  CornerEvidence(const capture::Board& board, const core::CameraModel& camera);

  /// `last` is the pose of the frame before, if that was posed: how the board moves in the image.
  void look_at(const capture::Frame& frame, const Eigen::Isometry3d& camera_from_board,
               const std::optional<Eigen::Isometry3d>& last);

  [[nodiscard]] std::vector<Finding> findings() const;

  /// Where the unknowns of each fault begin: focal length and two terms of distortion, principal
  /// point, bend (3), shutter (1).
  static constexpr int kLens = 0, kPrincipal = 3, kBend = 5, kShutter = 8, kUnknowns = 9;
  using Matrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;
  using Vector = Eigen::Matrix<double, kUnknowns, 1>;

  /// Normal equations of one frame, its pose taken out.
  struct View {
    Matrix H = Matrix::Zero();
    Vector g = Vector::Zero();
    double squares_px2 = 0;  ///< of the residuals
    int numbers = 0;         ///< residuals less the pose's freedoms
  };

  /// One fault fitted by itself.
  struct Pattern {
    Vector solution = Vector::Zero();
    double effect_px = 0;  ///< root mean square of what it explains
    double share = 0;      ///< of the squared residuals that it explains, [0, 1]
  };
  [[nodiscard]] Pattern fit(int first, int count) const;

 private:
  capture::Board board_;
  core::CameraModel camera_;
  /// Focal length, first two terms of distortion, principal point right and down.
  std::array<core::CameraModel, 5> changed_;
  double extent_m_ = 0;  ///< half of the board's longer side
  Eigen::Vector3d middle_;
  capture::TagTracker tracker_;
  Thinned<View> views_;
};

}  // namespace sheen::pipeline
