// SPDX-License-Identifier: MIT
#include "capture/pose/motion_prediction.h"

#include "capture/pose/rolling_shutter.h"

#include <algorithm>

namespace sheen::capture {
namespace {

/// The share `s` of a motion, 0 for none, 1 for all of it; beyond 1 it goes on.
Eigen::Isometry3d part_of(const Eigen::Isometry3d& motion, double s) {
  const Eigen::AngleAxisd turn(motion.linear());
  Eigen::Isometry3d part = Eigen::Isometry3d::Identity();
  part.linear() = Eigen::AngleAxisd(s * turn.angle(), turn.axis()).toRotationMatrix();
  part.translation() = s * motion.translation();
  return part;
}

Eigen::Isometry3d orthonormal(const Eigen::Isometry3d& transform) {
  Eigen::Isometry3d result = transform;
  result.linear() = Eigen::Quaterniond(transform.linear()).normalized().toRotationMatrix();
  return result;
}

}  // namespace

void MotionPrediction::note(const Frame& frame, const Eigen::Isometry3d& camera_from_board) {
  Known now;
  now.time_s = frame.time_s;
  now.index = frame.index;
  now.camera_from_board = camera_from_board;
  if (last_) {
    now.motion = camera_from_board * last_->camera_from_board.inverse();
    now.interval_s = frame.time_s - last_->time_s;
    now.frames = frame.index - last_->index;
  }
  last_ = now;
}

std::optional<Eigen::Isometry3d> MotionPrediction::last() const {
  if (!last_) return std::nullopt;
  return last_->camera_from_board;
}

std::optional<Twist> MotionPrediction::velocity() const {
  if (!last_ || !(last_->interval_s > 0)) return std::nullopt;
  return twist_between(Eigen::Isometry3d::Identity(), last_->motion) / last_->interval_s;
}

std::optional<Eigen::Isometry3d> MotionPrediction::predict(const Frame& frame) const {
  constexpr double longest = 3;  // times the last interval: farther ahead motion has changed
  if (!last_) return std::nullopt;
  const double interval_s = frame.time_s - last_->time_s;
  const int frames = frame.index - last_->index;
  double share = 1;
  if (interval_s > 0 && last_->interval_s > 0) {
    share = interval_s / last_->interval_s;
  } else if (frames > 0 && last_->frames > 0) {
    share = static_cast<double>(frames) / last_->frames;
  }
  const Eigen::Isometry3d motion = part_of(last_->motion, std::clamp(share, 0.0, longest));
  return orthonormal(motion * last_->camera_from_board);
}

}  // namespace sheen::capture
