// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "core/samples/observation.h"
#include "core/samples/surface_points.h"
#include "core/visibility/visibility.h"

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include <memory>

namespace sheen::pipeline {

/// Posed image -> observation: projects the vertices, rejects the hidden ones, reads the image. In
/// two steps, because a pose may still be refined between them. Keeps its storage from view to
/// view.
class ViewObserver {
 public:
  /// `visibility` holds the same mesh.
  ViewObserver(const core::Mesh& mesh, std::unique_ptr<core::Visibility> visibility,
               const core::SamplingLimits& limits, int threads);

  /// Which vertices a camera sees. Valid until the next call.
  const core::VertexView& see(const core::CameraModel& camera,
                              const Eigen::Isometry3d& camera_from_object);

  /// Reads `image` (CV_8UC3 BGR) where the camera last seen from shows the surface.
  core::SampleBatch& sample(const cv::Mat& image);

  /// Both steps. Points to `image`, `camera` and this; valid until the next call.
  core::Observation observe(int frame_index, const cv::Mat& image, const core::CameraModel& camera,
                            const Eigen::Isometry3d& camera_from_object);

  [[nodiscard]] const core::VertexView& view() const { return view_; }

 private:
  core::SurfacePoints points_;
  std::unique_ptr<core::Visibility> visibility_;
  core::SamplingLimits limits_;
  int threads_;
  core::VertexView view_;
  core::SampleBatch batch_;
};

}  // namespace sheen::pipeline
