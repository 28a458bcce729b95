// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/edge_alignment.h"
#include "capture/pose/tag_pattern.h"
#include "core/geometry/camera.h"

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include <array>
#include <optional>

namespace sheen::capture {

/// A tag of the board, ready to be looked for.
struct BoardTag {
  int id = 0;
  std::array<Eigen::Vector3d, 4> corners_in_board;  ///< in Board::Tag's order
  int modules = 8;                                  ///< bits across the black square
  TagPattern pattern;
};

/// A point of a tag's outline where a pose puts it in the image.
struct EdgePoint {
  Eigen::Vector2d px;
  Eigen::Vector2d outward;  ///< unit vector across the edge, out of the tag
  Twist outward_by_twist;   ///< how far the edge moves outwards with the board, px
};

/// A tag of the board where a pose puts it in the image, through the lens.
class TagView {
 public:
  /// No value for tags behind the camera, turned away, outside the image or too small to follow.
  static std::optional<TagView> find(const BoardTag& tag, const core::CameraModel& camera,
                                     const Eigen::Isometry3d& camera_from_board,
                                     const Twist& readout_motion);

  [[nodiscard]] const BoardTag& tag() const { return *tag_; }
  [[nodiscard]] const std::array<Eigen::Vector2d, 4>& corners_px() const { return corners_px_; }

  /// Height of a module behind a side, px. Side `s` runs from corner s to corner s + 1.
  [[nodiscard]] double module_px(std::size_t side) const { return module_px_[side]; }
  [[nodiscard]] double side_px(std::size_t side) const;

  /// `t` runs along the side from 0 to 1.
  [[nodiscard]] std::optional<EdgePoint> edge(const core::CameraModel& camera, std::size_t side,
                                              double t) const;

  /// The same point without its derivatives, px.
  [[nodiscard]] std::optional<Eigen::Vector2d> point_px(const core::CameraModel& camera,
                                                        std::size_t side, double t) const;

  /// Correlation of the tag's bits with the CV_8UC1 image, -1 to 1; -1 when fewer than three
  /// quarters of them lie in the image.
  [[nodiscard]] double pattern_correlation(const core::CameraModel& camera,
                                           const cv::Mat& grey) const;

 private:
  TagView() = default;

  const BoardTag* tag_ = nullptr;                     // not owned, outlives the view
  std::array<Eigen::Vector3d, 4> corners_in_camera_;  // each when its row is read
  std::array<Eigen::Vector2d, 4> corners_px_;
  std::array<double, 4> module_px_{};
};

}  // namespace sheen::capture
