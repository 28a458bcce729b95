// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/kept_views/kept_view.h"

#include <Eigen/Core>

#include <optional>
#include <span>

namespace sheen::fitting::multi_eigenspace {

/// What pictures show: a sphere round the object, seen upright. Object frame, metres.
struct PictureFrame {
  Eigen::Vector3d centre;
  double radius_m;
  Eigen::Vector3d up;  ///< unit
};

/// A square through the middle of the sphere that faces an eye. The sphere's outline, as seen from
/// there, is the circle inscribed in it: distance and roll of a camera do not show in its picture.
struct Billboard {
  Eigen::Vector3d right, down, towards_eye;  ///< unit, orthogonal
  double distance_m;                         ///< from the middle to the eye
  double half_side_m;
};

/// Nothing for an eye in the middle. Within the sphere as from just outside it.
std::optional<Billboard> billboard_towards(const PictureFrame& frame, const Eigen::Vector3d& eye);

/// Whether an eye is far enough from the sphere to give a picture of it.
bool sees_all(const PictureFrame& frame, const Eigen::Vector3d& eye);

/// The direction in which photographs stand upright: that to which their rows are orthogonal. Unit;
/// `views` is not empty.
Eigen::Vector3d upright(std::span<const KeptView> views);

}  // namespace sheen::fitting::multi_eigenspace
