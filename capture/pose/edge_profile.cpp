// SPDX-License-Identifier: MIT
#include "capture/pose/edge_profile.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace sheen::capture {
namespace {

/// Bilinear read-out; the caller has checked that the point lies inside.
double brightness(const cv::Mat& grey, const Eigen::Vector2d& px) {
  const int x = std::min(static_cast<int>(px.x()), grey.cols - 2);
  const int y = std::min(static_cast<int>(px.y()), grey.rows - 2);
  const double fx = px.x() - x;
  const double fy = px.y() - y;
  const auto* upper = grey.ptr<unsigned char>(y) + x;
  const auto* lower = grey.ptr<unsigned char>(y + 1) + x;
  return (1 - fy) * ((1 - fx) * upper[0] + fx * upper[1]) +
         fy * ((1 - fx) * lower[0] + fx * lower[1]);
}

bool is_inside(const cv::Mat& grey, const Eigen::Vector2d& px) {
  return px.x() >= 0 && px.y() >= 0 && px.x() <= grey.cols - 1 && px.y() <= grey.rows - 1;
}

}  // namespace

TagSide::TagSide(const core::CameraModel& camera, const Eigen::Vector2d& begin_px,
                 const Eigen::Vector2d& end_px, const Eigen::Vector2d& inside_px)
    : camera_(&camera), begin_px_(begin_px), end_px_(end_px) {
  const Eigen::Vector2d along = (end_px - begin_px).normalized();
  outward_ = Eigen::Vector2d(along.y(), -along.x());
  if (outward_.dot(begin_px - inside_px) < 0) outward_ = -outward_;

  const auto begin_ray = camera.unproject(begin_px);
  const auto end_ray = camera.unproject(end_px);
  if (begin_ray && end_ray) ideal_ = {begin_ray->head<2>(), end_ray->head<2>()};
}

Eigen::Vector2d TagSide::point(double t) const {
  if (!ideal_) return begin_px_ + t * (end_px_ - begin_px_);
  const Eigen::Vector2d ideal = (*ideal_)[0] + t * ((*ideal_)[1] - (*ideal_)[0]);
  const auto& intrinsics = camera_->intrinsics();
  return camera_->distort(ideal).cwiseProduct(intrinsics.focal_px) + intrinsics.principal_px;
}

std::optional<EdgeProfile> EdgeProfile::sample(const cv::Mat& grey,
                                               const Eigen::Vector2d& centre_px,
                                               const Eigen::Vector2d& outward,
                                               double half_length_px) {
  assert(grey.type() == CV_8UC1);
  const Eigen::Vector2d reach = outward * half_length_px;
  if (grey.cols < 2 || grey.rows < 2 || !is_inside(grey, centre_px - reach) ||
      !is_inside(grey, centre_px + reach)) {
    return std::nullopt;
  }
  EdgeProfile profile;
  profile.half_length_px_ = half_length_px;
  for (int i = 0; i <= kSteps; ++i) {
    const double along = 2.0 * i / kSteps - 1;
    profile.values_[static_cast<std::size_t>(i)] = brightness(grey, centre_px + along * reach);
  }
  return profile;
}

bool EdgeProfile::has_contrast() const {
  constexpr double min_contrast = 16;  // of 255: below it noise decides where the edge lies
  return std::abs(outside_level() - inside_level()) >= min_contrast;
}

std::optional<double> EdgeProfile::position_px() const {
  if (!has_contrast()) return std::nullopt;
  // A step from 0 to 1 at x has the integral half_length - x over the line (trapezoid rule).
  const double inside = inside_level();
  const double contrast = outside_level() - inside;
  double sum = std::accumulate(values_.begin(), values_.end(), 0.0);
  sum -= (values_.front() + values_.back()) / 2;
  const double integral = (sum / kSteps - inside) / contrast * 2 * half_length_px_;
  return half_length_px_ - integral;
}

double EdgeProfile::crossing(double level, int from, int step) const {
  const double sign = outside_level() > inside_level() ? 1 : -1;
  const auto excess = [&](int i) {
    return sign * step * (values_[static_cast<std::size_t>(i)] - level);
  };
  for (int i = from; i >= 0 && i <= kSteps; i += step) {
    if (excess(i) < 0) continue;
    if (i == from) return from;
    const double before = -excess(i - step);
    return i - step * (1 - before / (before + excess(i)));
  }
  return step > 0 ? kSteps : 0;
}

std::optional<double> EdgeProfile::rise_width_px() const {
  if (!has_contrast()) return std::nullopt;
  const double inside = inside_level();
  const double contrast = outside_level() - inside;

  // Start where half of the step is reached and walk to both sides.
  const double position = position_px().value_or(0);
  const double centre =
      std::clamp((position / half_length_px_ + 1) / 2 * kSteps, 0.0, 1.0 * kSteps);
  const int from = static_cast<int>(std::lround(centre));
  const double low = crossing(inside + 0.1 * contrast, from, -1);
  const double high = crossing(inside + 0.9 * contrast, from, +1);
  return (high - low) * 2 * half_length_px_ / kSteps;
}

}  // namespace sheen::capture
