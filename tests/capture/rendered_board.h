// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board.h"
#include "core/geometry/camera.h"

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include <array>
#include <map>

namespace sheen::capture::test {

/// How the print is photographed.
struct Photograph {
  double dark = 40;            ///< grey of ink, of 255
  double light = 215;          ///< grey of paper
  double blur_sigma_px = 0.6;  ///< Gaussian blur of the lens
  int motion_px = 0;           ///< length of a horizontal motion blur, 0 for none
  double noise = 0;            ///< standard deviation, of 255
  unsigned seed = 1;           ///< of the noise
  int supersampling = 5;       ///< rays per pixel and axis
};

/// Image of a board whose tags lie in the board plane, drawn from the codes that libapriltag and
/// OpenCV print, by a ray through every sub-pixel and OpenCV's own undistortion. CV_8UC3.
cv::Mat render_board(const Board& board, const core::CameraModel& camera,
                     const Eigen::Isometry3d& camera_from_board, const Photograph& photograph);

/// Where OpenCV projects the corners of every tag: lower left, lower right, upper right, upper
/// left.
std::map<int, std::array<Eigen::Vector2d, 4>> true_corners(
    const Board& board, const core::CameraModel& camera,
    const Eigen::Isometry3d& camera_from_board);

/// Columns x rows tags of one size around the board's origin, ids row by row from the top left.
Board make_grid_board(const std::string& family, int columns, int rows, double size_m,
                      double pitch_m);

/// Camera of the given size with a field of view of about 65 degrees.
core::CameraModel make_camera(int width_px, int height_px, bool distorted);

/// Pose of a camera `distance_m` from the board's origin that looks at it, `elevation` above the
/// plane and `azimuth` around it (radians).
Eigen::Isometry3d look_at_board(double distance_m, double elevation, double azimuth);

}  // namespace sheen::capture::test
