// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"
#include "core/samples/sample_batch.h"
#include "core/samples/vertex_view.h"

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

namespace sheen::core {

/// A posed image and what it shows of the surface: what a light field is fitted to. It points to
/// parts that belong to whoever made it; a fitter that wants to keep something copies it (`image`
/// shares its pixels).
struct Observation {
  int frame_index = 0;
  const cv::Mat& image;                  ///< CV_8UC3 BGR, lens distortion included
  const CameraModel& camera;             ///< of this image
  Eigen::Isometry3d camera_from_object;  ///< metres
  const VertexView& view;                ///< every vertex of the mesh as this camera sees it
  const SampleBatch& samples;            ///< radiance at the vertices that are seen
  double gain = 1;                       ///< the image's exposure: samples are its values over this
  /// CV_32FC1 of the image's size: depth along the optical axis as a sensor measured it, metres, 0
  /// where it did not; empty where there is none, or no fitter wants it (Fitter::needs_depth).
  cv::Mat depth_m{};
};

}  // namespace sheen::core
