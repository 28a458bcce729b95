// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"
#include "reconstruction/views/projection.h"

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include <vector>

namespace sheen::reconstruction {

/// An image whose camera is known.
struct View {
  int frame_index = 0;
  cv::Mat image;  ///< CV_8UC3, BGR, distorted as the lens made it
  Eigen::Isometry3d camera_from_board = Eigen::Isometry3d::Identity();
  Projection project;
};

/// Images of one camera.
struct ViewSet {
  core::CameraModel camera;
  cv::Mat rays;  ///< CV_32FC2, per pixel: its ray's place in the plane z = 1; NaN beyond the lens
  std::vector<View> views;
};

/// An image and its pose, before anything is computed from them.
struct PosedImage {
  int frame_index = 0;
  cv::Mat image;  ///< CV_8UC3, BGR
  Eigen::Isometry3d camera_from_board = Eigen::Isometry3d::Identity();
};

ViewSet make_view_set(const core::CameraModel& camera, const std::vector<PosedImage>& images,
                      int threads);

/// The smallest whole factor that makes images of a width no wider than `widest_px`.
int reduction(int width_px, int widest_px);
/// Means of blocks of `factor` x `factor` pixels; what fills no block is left out. Factor 1: the
/// image itself, shared.
cv::Mat reduced(const cv::Mat& image, int factor);
/// The camera of such images.
core::CameraModel reduced(const core::CameraModel& camera, int factor);

/// At most `most` of the views, spread evenly, their images reduced by the smallest whole factor
/// that makes them no wider than `widest_px`.
ViewSet reduced(const ViewSet& views, std::size_t most, int widest_px, int threads);

/// Where the ray of a pixel meets the plane z = 0: board frame, metres. NaN where it does not, or
/// so flatly that nothing can be learned (less than two degrees).
cv::Mat plane_points(const ViewSet& views, const View& view);

}  // namespace sheen::reconstruction
