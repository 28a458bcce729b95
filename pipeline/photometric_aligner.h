// SPDX-License-Identifier: MIT
#pragma once

#include "core/alignment/align_pose.h"
#include "core/alignment/exposure.h"
#include "core/alignment/gradient_image.h"
#include "core/alignment/select_points.h"
#include "core/mesh/mesh.h"
#include "core/samples/sample_batch.h"
#include "core/samples/vertex_view.h"
#include "fitting/patch_light_field.h"

#include <opencv2/core/mat.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace sheen::pipeline {

/// Compares images with a light field: refines a frame's pose, finds its exposure. Only patches
/// that enough frames have seen take part.
class PhotometricAligner {
 public:
  /// `pose_error_px` is the error expected of the poses to be refined, in the image.
  PhotometricAligner(const core::Mesh& mesh, double pose_error_px);

  /// Counts the samples that the model has integrated.
  void note_integrated(const core::SampleBatch& batch);

  /// Pose under which `image` agrees better with `model`; nothing when that cannot be said.
  /// `view` is the mesh seen from the start, occlusion included.
  [[nodiscard]] std::optional<core::Alignment> align(const cv::Mat& image,
                                                     const core::VertexView& view,
                                                     const fitting::PatchLightField& model,
                                                     const core::CameraModel& camera,
                                                     const Eigen::Isometry3d& camera_from_object);

  /// Exposure of a frame's samples against `model`.
  [[nodiscard]] std::optional<double> gain(const core::SampleBatch& batch,
                                           const fitting::PatchLightField& model);

 private:
  void expect(const core::VertexView& view, const fitting::PatchLightField& model);

  const core::Mesh& mesh_;
  double pose_error_px_;
  core::VertexNeighbours neighbours_;
  std::vector<std::uint16_t> seen_;      ///< samples integrated per patch
  std::vector<std::uint8_t> is_usable_;  ///< seen often enough to be compared with
  core::GradientImage image_;
  std::vector<std::uint32_t> selected_;
  core::ExpectedPoints points_;
  std::vector<float> measured_, predicted_;
  std::vector<double> ratios_;
};

/// Takes an exposure out of a frame's samples: divides them by `gain`, clipped to [0, 1].
void divide_by_gain(double gain, core::SampleBatch& batch);

}  // namespace sheen::pipeline
