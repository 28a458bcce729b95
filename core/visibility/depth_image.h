// SPDX-License-Identifier: MIT
#pragma once

#include "core/visibility/z_buffer.h"

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>

namespace sheen::core {

/// How far a mesh lies behind every pixel of a view, as an image. Keeps its storage from view to
/// view.
class DepthImage {
 public:
  /// Copies what it needs from the mesh.
  DepthImage(const Mesh& mesh, int threads);

  /// Draws the fronts of the mesh as `view`, its projection by a camera of this size and pose, has
  /// them; straight edges between vertices (ZBuffer).
  void draw(const VertexView& view, const cv::Size& image_size,
            const Eigen::Isometry3d& camera_from_object);

  /// Pixels of the image that may show the mesh; empty where none does.
  [[nodiscard]] const cv::Rect& box() const { return box_; }

  /// CV_32FC1 of the box's size: depth along the optical axis, metres; 0 where nothing is.
  [[nodiscard]] const cv::Mat& depth_m() const { return depth_m_; }

 private:
  ZBuffer buffer_;
  int threads_;
  cv::Rect box_;
  cv::Mat depth_m_;
};

}  // namespace sheen::core
