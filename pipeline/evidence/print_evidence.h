// SPDX-License-Identifier: MIT
#pragma once

#include "core/alignment/gradient_image.h"
#include "core/geometry/camera.h"
#include "core/mesh/mesh.h"
#include "core/samples/vertex_view.h"
#include "pipeline/evidence/finding.h"
#include "pipeline/thinned.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace sheen::pipeline {

/// Where the object's print lies on the mesh: an object that was nudged shows it elsewhere from
/// some frame on, by less than its outline tells. Luma without what is smooth over some pixels, at
/// some hundred vertices: each has a value that changes linearly with the slope of the view against
/// its normal, which takes up gloss and a surface that lies too high or too low, and one shift for
/// all of them, along the mean gradient that the vertex shows, sets in with a frame.
class PrintEvidence {
 public:
  /// `mesh` must outlive this.
  explicit PrintEvidence(const core::Mesh& mesh);

  /// `image` is CV_8UC3, BGR; `view` is the mesh seen from there.
  void look_at(int frame_index, const cv::Mat& image, const core::VertexView& view,
               const core::CameraModel& camera, const Eigen::Isometry3d& camera_from_object);

  [[nodiscard]] std::vector<Finding> findings() const;

  /// A shift that begins with one frame.
  struct Jump {
    int frame_index = 0;
    Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();  ///< object frame
    double shift_px = 0;                                ///< in the usual view
    double certainty = 0;                               ///< standard deviations from zero
  };
  [[nodiscard]] std::optional<Jump> jump() const;

 private:
  /// What a view shows at a vertex.
  struct Sample {
    std::uint32_t vertex_idx = 0;
    float value = 0;           ///< luma less the smooth part
    Eigen::Vector2f slope;     ///< of the view against the normal, tangent of the angle
    Eigen::Vector2f gradient;  ///< of the value, per metre along tangent and bitangent
  };
  struct View {
    int frame_index = 0;
    double px_per_m = 0;  ///< where the object stands
    std::vector<Sample> samples;
  };
  struct Vertex;
  [[nodiscard]] std::vector<Vertex> vertices() const;
  [[nodiscard]] Jump jump_at(std::size_t split, const std::vector<Vertex>& vertices) const;

  const core::Mesh& mesh_;
  std::size_t spacing_;  ///< of the vertices that are looked at
  core::GradientImage sharp_;
  Thinned<View> views_;
};

}  // namespace sheen::pipeline
