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
#include <cstddef>
#include <optional>
#include <vector>

namespace sheen::pipeline {

/// What is left of the tags' corners when every frame has its best pose, against the patterns that
/// known faults leave there: another lens, a principal point elsewhere, a bent board, rows that are
/// read one after the other. Poses take up most of such a fault; the rest of it, projected off the
/// six freedoms of each pose, is fitted by one small linear least squares over all frames per
/// fault. Where nothing is wrong, poses and images may still be poor: by tags that all lie to one
/// side of the object, and by blur.
class CornerEvidence {
 public:
  /// `object_in_board` are points that enclose the object. Of the frames that come every
  /// `spacing`-th is looked at, and of many fewer.
  CornerEvidence(const capture::Board& board, const core::CameraModel& camera,
                 std::vector<Eigen::Vector3d> object_in_board, std::size_t spacing = 4);

  /// `last` is the pose of the frame before, if that was posed: how the board moves in the image.
  void look_at(const capture::Frame& frame, const Eigen::Isometry3d& camera_from_board,
               const std::optional<Eigen::Isometry3d>& last);

  /// What is not as the files say.
  [[nodiscard]] std::vector<Finding> findings() const;

  /// What makes poses or images poor although they fit.
  [[nodiscard]] std::vector<Finding> weaknesses() const;

  /// How far the object moves in the image, RMS over its points, if every corner is off by 1 px
  /// independently and the pose takes that up; of the usual view. No value where nothing was seen.
  [[nodiscard]] std::optional<double> leverage() const;

  /// Width of the tags' edges in the usual view, px (capture::tag_edge_width).
  [[nodiscard]] std::optional<double> blur_px() const;

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
    std::optional<double> leverage, blur_px;
  };

  /// One fault fitted by itself.
  struct Pattern {
    Vector solution = Vector::Zero();
    double effect_px = 0;  ///< root mean square of what it explains
    double share = 0;      ///< of the squared residuals that it explains, [0, 1]
  };
  [[nodiscard]] Pattern fit(int first, int count) const;

 private:
  [[nodiscard]] double leverage_of(const Eigen::MatrixXd& by_pose,
                                   const Eigen::Isometry3d& camera_from_board) const;

  capture::Board board_;
  core::CameraModel camera_;
  /// Focal length, first two terms of distortion, principal point right and down.
  std::array<core::CameraModel, 5> changed_;
  double extent_m_ = 0;  ///< half of the board's longer side
  Eigen::Vector3d middle_;
  std::vector<Eigen::Vector3d> object_in_board_;
  capture::TagTracker tracker_;
  Thinned<View> views_;
};

}  // namespace sheen::pipeline
