// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board.h"
#include "core/geometry/camera.h"
#include "reconstruction/views/view_set.h"

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include <cmath>
#include <numbers>
#include <vector>

namespace sheen::tests {

/// Twelve tags round an empty middle, 20 cm from first to last centre.
inline capture::Board ring_board() {
  capture::Board board;
  board.family = "tag36h11";
  int id = 0;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      if ((row == 1 || row == 2) && (column == 1 || column == 2)) continue;
      capture::Board::Tag tag;
      tag.size_m = 0.04;
      tag.board_from_tag.translation() =
          Eigen::Vector3d((column - 1.5) * 0.2 / 3, (row - 1.5) * 0.2 / 3, 0);
      board.tags[id++] = tag;
    }
  }
  return board;
}

inline core::CameraModel small_camera(int width_px, int height_px) {
  core::CameraModel::Intrinsics intrinsics;
  intrinsics.width_px = width_px;
  intrinsics.height_px = height_px;
  intrinsics.focal_px = Eigen::Vector2d::Constant(1.1 * width_px);
  intrinsics.principal_px = {0.5 * (width_px - 1), 0.5 * (height_px - 1)};
  return core::CameraModel(intrinsics);
}

/// A camera at `eye` that looks at `target`, board z upwards in the image.
inline Eigen::Isometry3d look_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target) {
  const Eigen::Vector3d z = (target - eye).normalized();
  const Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Isometry3d camera_from_board = Eigen::Isometry3d::Identity();
  camera_from_board.linear().row(0) = x.transpose();
  camera_from_board.linear().row(1) = z.cross(x).transpose();
  camera_from_board.linear().row(2) = z.transpose();
  camera_from_board.translation() = -camera_from_board.linear() * eye;
  return camera_from_board;
}

/// Poses on a circle round `target`; `arc_deg` of it.
inline std::vector<Eigen::Isometry3d> ring_of_poses(int count, double distance_m,
                                                    double elevation_deg,
                                                    const Eigen::Vector3d& target,
                                                    double arc_deg = 360) {
  std::vector<Eigen::Isometry3d> poses;
  const double up = elevation_deg * std::numbers::pi / 180;
  for (int i = 0; i < count; ++i) {
    const double turn = arc_deg * std::numbers::pi / 180 * i / count;
    const Eigen::Vector3d sight(std::cos(up) * std::cos(turn), std::cos(up) * std::sin(turn),
                                std::sin(up));
    poses.push_back(look_at(target + distance_m * sight, target));
  }
  return poses;
}

inline reconstruction::ViewSet views_without_images(const core::CameraModel& camera,
                                                    const std::vector<Eigen::Isometry3d>& poses) {
  std::vector<reconstruction::PosedImage> images;
  for (const auto& pose : poses) images.push_back({0, {}, pose});
  return reconstruction::make_view_set(camera, images, 1);
}

}  // namespace sheen::tests
