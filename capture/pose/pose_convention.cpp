// SPDX-License-Identifier: MIT
#include "capture/pose/pose_convention.h"

#include <array>
#include <cstddef>

namespace sheen::capture {
namespace {

constexpr double kNearlyAll = 0.9, kFew = 0.5;  // of the views

/// What was done to a pose before it was written; undone by `ours`.
struct Change {
  bool is_w_first = false;
  bool is_inverse = false;
  bool looks_backwards = false;
};

// The likelier ones first.
constexpr std::array<Change, 7> kChanges{{{false, true, false},
                                          {false, false, true},
                                          {true, false, false},
                                          {false, true, true},
                                          {true, true, false},
                                          {true, false, true},
                                          {true, true, true}}};

Eigen::Isometry3d ours(const Eigen::Isometry3d& as_read, const Change& change) {
  Eigen::Isometry3d pose = as_read;  // board_from_camera
  if (change.is_w_first) {
    const Eigen::Quaterniond q(as_read.linear());
    pose.linear() = Eigen::Quaterniond(q.x(), q.y(), q.z(), q.w()).toRotationMatrix();
  }
  if (change.is_inverse) pose = pose.inverse();
  if (change.looks_backwards) {
    pose.linear() = pose.linear() * Eigen::Vector3d(1, -1, -1).asDiagonal();
  }
  return pose;
}

double share_seen(std::span<const Eigen::Isometry3d> camera_from_board,
                  const core::CameraModel& camera, const Eigen::Vector3d& in_board,
                  const Change& change) {
  std::size_t seen = 0;
  for (const Eigen::Isometry3d& pose : camera_from_board) {
    const auto pixel = camera.project(ours(pose.inverse(), change).inverse() * in_board);
    seen += pixel && pixel->x() >= 0 && pixel->y() >= 0 && pixel->x() < camera.width_px() &&
                    pixel->y() < camera.height_px()
                ? 1
                : 0;
  }
  return static_cast<double>(seen) / static_cast<double>(camera_from_board.size());
}

PoseConvention described(const Change& change) {
  std::string fault, remedy;
  const auto add = [](std::string& text, const char* more) {
    text += text.empty() ? more : std::string(" and ") + more;
  };
  if (change.is_w_first) {
    add(fault, "their quaternions begin with w");
    add(remedy, "write qx qy qz qw");
  }
  if (change.is_inverse) {
    add(fault, "they take the board to the camera");
    add(remedy, "invert them");
  }
  if (change.looks_backwards) {
    add(fault, "their cameras look along -z with y up, as in OpenGL, Blender and NeRF");
    add(remedy, "turn every camera by 180 degrees about its x axis");
  }
  return {"its poses fit the images if " + fault, remedy};
}

}  // namespace

std::optional<PoseConvention> other_convention(std::span<const Eigen::Isometry3d> camera_from_board,
                                               const core::CameraModel& camera,
                                               const Eigen::Vector3d& in_board) {
  if (camera_from_board.empty()) return std::nullopt;
  if (share_seen(camera_from_board, camera, in_board, {}) > kFew) return std::nullopt;
  for (const Change& change : kChanges) {
    if (share_seen(camera_from_board, camera, in_board, change) < kNearlyAll) continue;
    return described(change);
  }
  return std::nullopt;
}

}  // namespace sheen::capture
