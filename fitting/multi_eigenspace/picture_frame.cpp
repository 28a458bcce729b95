// SPDX-License-Identifier: MIT
#include "fitting/multi_eigenspace/picture_frame.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace sheen::fitting::multi_eigenspace {
namespace {

/// Of the radius: nearer eyes do not see the sphere's outline.
constexpr double kNearest = 1.05;

}  // namespace

std::optional<Billboard> billboard_towards(const PictureFrame& frame, const Eigen::Vector3d& eye) {
  const Eigen::Vector3d out = eye - frame.centre;
  const double distance = out.norm();
  constexpr double least = 1e-6;
  if (!(distance > least * frame.radius_m)) return std::nullopt;
  Billboard board;
  board.distance_m = distance;
  board.towards_eye = out / distance;
  board.right = frame.up.cross(board.towards_eye);
  // From straight above nothing is upright.
  board.right = board.right.norm() > least ? Eigen::Vector3d(board.right.normalized())
                                           : frame.up.unitOrthogonal();
  board.down = -board.towards_eye.cross(board.right);
  const double outside = std::max(distance, kNearest * frame.radius_m);
  board.half_side_m =
      frame.radius_m * outside / std::sqrt(outside * outside - frame.radius_m * frame.radius_m);
  return board;
}

bool sees_all(const PictureFrame& frame, const Eigen::Vector3d& eye) {
  return (eye - frame.centre).norm() > kNearest * frame.radius_m;
}

Eigen::Vector3d upright(std::span<const KeptView> views) {
  // Rows of a pose are the camera's axes: x along the image's rows, y down its columns.
  Eigen::Matrix3d rows = Eigen::Matrix3d::Zero();
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  for (const KeptView& view : views) {
    const Eigen::Vector3d right = view.camera_from_object.linear().row(0);
    rows += right * right.transpose();
    up -= view.camera_from_object.linear().row(1).transpose();
  }
  constexpr double least = 1e-6;
  if (!(up.norm() > least)) up = Eigen::Vector3d::UnitZ();
  up.normalize();
  // Where few directions leave it open, near their mean.
  constexpr double hold = 0.01;
  rows += hold * static_cast<double>(views.size()) *
          (Eigen::Matrix3d::Identity() - up * up.transpose());
  const Eigen::Vector3d least_axis =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(rows).eigenvectors().col(0);
  return least_axis.dot(up) < 0 ? Eigen::Vector3d(-least_axis) : least_axis;
}

}  // namespace sheen::fitting::multi_eigenspace
