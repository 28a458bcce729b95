// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include <array>
#include <optional>

namespace sheen::capture {

/// One side of a tag's black square in an image: straight on the print, bent by the lens.
class TagSide {
 public:
  /// Through the corners `begin_px` and `end_px`; `inside_px` is any point of the tag.
  TagSide(const core::CameraModel& camera, const Eigen::Vector2d& begin_px,
          const Eigen::Vector2d& end_px, const Eigen::Vector2d& inside_px);

  /// Point of the side, px; `t` runs from 0 at the beginning to 1 at the end.
  [[nodiscard]] Eigen::Vector2d point(double t) const;

  /// Unit vector across the side, out of the tag.
  [[nodiscard]] const Eigen::Vector2d& outward() const { return outward_; }
  [[nodiscard]] double length_px() const { return (end_px_ - begin_px_).norm(); }

 private:
  const core::CameraModel* camera_;  // not owned, outlives the side
  Eigen::Vector2d begin_px_, end_px_, outward_;
  // Ends in the plane z = 1; without a value the side is taken as straight.
  std::optional<std::array<Eigen::Vector2d, 2>> ideal_;
};

/// Brightness along a short straight line across an edge, from inside the tag to outside.
class EdgeProfile {
 public:
  /// Line of length 2 `half_length_px` around `centre_px`; no value where it leaves the image.
  /// `grey` is CV_8UC1, `outward` a unit vector.
  static std::optional<EdgeProfile> sample(const cv::Mat& grey, const Eigen::Vector2d& centre_px,
                                           const Eigen::Vector2d& outward, double half_length_px);

  /// Where the edge lies against the centre of the line, px, positive outwards: the position at
  /// which an ideal step has the same integral. No value without contrast.
  [[nodiscard]] std::optional<double> position_px() const;

  /// Where the strongest step from dark to bright (outwards; `sign` +1) or back (-1) lies, px from
  /// the centre, positive outwards. No value without contrast. Coarse: meant for edges far off.
  [[nodiscard]] std::optional<double> strongest_step_px(int sign) const;

  /// Bright outside: +1, dark outside: -1, no contrast: 0.
  [[nodiscard]] int polarity() const;

  /// Distance between 10 % and 90 % of the step, px; at most the length of the line. No value
  /// without contrast.
  [[nodiscard]] std::optional<double> rise_width_px() const;

 private:
  static constexpr int kSteps = 32;
  EdgeProfile() = default;
  [[nodiscard]] float inside_level() const { return (values_[0] + values_[1]) / 2; }
  [[nodiscard]] float outside_level() const { return (values_[kSteps] + values_[kSteps - 1]) / 2; }
  [[nodiscard]] double crossing(double level, int from, int step) const;

  double half_length_px_ = 0;
  std::array<float, kSteps + 1> values_;
};

}  // namespace sheen::capture
