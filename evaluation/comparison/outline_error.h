// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"
#include "core/mesh/mesh.h"
#include "core/samples/vertex_view.h"
#include "core/visibility/depth_image.h"
#include "render/renderer.h"

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

namespace sheen::evaluation {

/// How well a model draws where the object ends. Of one view, or means over views.
struct OutlineError {
  double box_psnr_db = 0;      ///< over the box around the object, all else black in both images
  double edge_difference = 0;  ///< mean absolute difference in the edge band, grey levels
  double hole_fraction = 0;    ///< of the object's pixels that the model leaves uncovered
};

/// The pixels of a mesh that lie near its outline or a jump of its depth.
class EdgeBand {
 public:
  /// Copies what it needs from the mesh.
  EdgeBand(const core::Mesh& mesh, int threads);

  /// CV_8UC1 of the camera's size: 255 for the object's pixels within three of an edge.
  cv::Mat seen_by(const core::CameraModel& camera, const Eigen::Isometry3d& camera_from_object);

 private:
  core::SurfacePoints points_;
  core::DepthImage depth_;
  core::VertexView view_;
  int threads_;
};

/// `mask`: CV_8UC1, where the object is seen in the photograph; not empty. The object's own pixels
/// are counted for holes less two at its outline, as everywhere (compare_view).
OutlineError outline_error(const render::RenderedView& rendered, const cv::Mat& photograph,
                           const cv::Mat& mask, const cv::Mat& edge_band);

}  // namespace sheen::evaluation
