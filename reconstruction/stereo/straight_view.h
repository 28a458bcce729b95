// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "reconstruction/views/view_set.h"

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include <vector>

namespace sheen::reconstruction {

/// A view as a camera without distortion would have taken it: points on a ray move along a line.
struct StraightView {
  cv::Mat luma;       ///< CV_32FC1, [0, 1]
  cv::Mat hull;       ///< CV_32FC1: depth of the hull, metres; 0: not seen
  cv::Mat is_object;  ///< CV_8UC1, not 0 within the hull's outline, which may lie a little wrong
  Eigen::Matrix3f pixel_from_board_turn;   ///< K R: board directions to homogeneous pixels
  Eigen::Vector3f pixel_from_board_shift;  ///< K t, metres
  Eigen::Matrix3f ray_of_pixel;            ///< R^T K^-1: pixel (x, y, 1) to its ray, board frame;
                                           ///< one metre deep along the optical axis
  Projection project;                      ///< the same camera
};

/// All views with their images straightened; `hull` in the board frame. Threads do not change the
/// result.
std::vector<StraightView> straighten(const ViewSet& views, const core::Mesh& hull, int threads);

}  // namespace sheen::reconstruction
