// SPDX-License-Identifier: MIT
#include "capture/pose/edge_profile.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace sheen::capture {
namespace {

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
  // Bilinear read-out; both ends lie inside, hence every point does.
  EdgeProfile profile;
  profile.half_length_px_ = half_length_px;
  const Eigen::Vector2f begin = (centre_px - reach).cast<float>();
  const Eigen::Vector2f step = (reach * (2.0 / kSteps)).cast<float>();
  const std::size_t stride = grey.step;
  const unsigned char* const pixels = grey.data;
  for (int i = 0; i <= kSteps; ++i) {
    const float px = std::max(begin.x() + static_cast<float>(i) * step.x(), 0.0F);
    const float py = std::max(begin.y() + static_cast<float>(i) * step.y(), 0.0F);
    const int x = std::min(static_cast<int>(px), grey.cols - 2);
    const int y = std::min(static_cast<int>(py), grey.rows - 2);
    const float fx = px - static_cast<float>(x);
    const float fy = py - static_cast<float>(y);
    const unsigned char* upper =
        pixels + static_cast<std::size_t>(y) * stride + static_cast<std::size_t>(x);
    const unsigned char* lower = upper + stride;
    const float above = static_cast<float>(upper[0]) + fx * static_cast<float>(upper[1] - upper[0]);
    const float below = static_cast<float>(lower[0]) + fx * static_cast<float>(lower[1] - lower[0]);
    profile.values_[static_cast<std::size_t>(i)] = above + fy * (below - above);
  }
  return profile;
}

int EdgeProfile::polarity() const {
  constexpr float min_contrast = 16;  // of 255: below it noise decides where the edge lies
  const float step = outside_level() - inside_level();
  return step >= min_contrast ? 1 : step <= -min_contrast ? -1 : 0;
}

std::optional<double> EdgeProfile::strongest_step_px(int sign) const {
  constexpr float min_step = 16;     // of 255
  constexpr double window_px = 1.5;  // on either side: wider than the noise, narrower than a module
  const int window =
      std::clamp(static_cast<int>(std::lround(window_px * kSteps / (2 * half_length_px_))), 1, 8);
  float strongest = min_step * static_cast<float>(window);
  int found = -1;
  for (int i = window; i <= kSteps - window; ++i) {
    float step = 0;
    for (int k = 1; k <= window; ++k) {
      step += values_[static_cast<std::size_t>(i + k)] - values_[static_cast<std::size_t>(i - k)];
    }
    if (step * static_cast<float>(sign) <= strongest) continue;
    strongest = step * static_cast<float>(sign);
    found = i;
  }
  if (found < 0) return std::nullopt;
  return (2.0 * found / kSteps - 1) * half_length_px_;
}

std::optional<double> EdgeProfile::position_px() const {
  if (polarity() == 0) return std::nullopt;
  // A step from 0 to 1 at x has the integral half_length - x over the line (trapezoid rule).
  const float inside = inside_level();
  const float contrast = outside_level() - inside;
  float sum = std::accumulate(values_.begin(), values_.end(), 0.0F);
  sum -= (values_.front() + values_.back()) / 2;
  const double bright_share = static_cast<double>((sum / kSteps - inside) / contrast);
  return half_length_px_ * (1 - 2 * bright_share);
}

double EdgeProfile::crossing(double level, int from, int step) const {
  const double sign = outside_level() > inside_level() ? 1 : -1;
  const auto excess = [&](int i) {
    return sign * step * (static_cast<double>(values_[static_cast<std::size_t>(i)]) - level);
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
  if (polarity() == 0) return std::nullopt;
  const auto inside = static_cast<double>(inside_level());
  const double contrast = static_cast<double>(outside_level()) - inside;

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
