// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/tangent_frame.h"
#include "core/mesh/mesh.h"
#include "core/samples/sample_batch.h"
#include "core/visibility/ray_caster.h"
#include "evaluation/study/lumisphere.h"
#include "fitting/patch_light_field.h"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace sheen::evaluation {

/// A ring of several materials, lying on a board, whose radiance is known: a camera that walks
/// round it gets a sample of every vertex it sees.
class WalkScene {
 public:
  /// `seed` decides materials and colours.
  explicit WalkScene(std::uint64_t seed);

  [[nodiscard]] const core::Mesh& mesh() const { return mesh_; }
  [[nodiscard]] const core::RayCaster& caster() const { return caster_; }

  /// What a camera at `eye` (object frame) sees, with noise of .01; `key` decides the noise.
  [[nodiscard]] core::SampleBatch look(const Eigen::Vector3f& eye, std::uint64_t key) const;

  /// Squared error of a model as displayed, mean of the channels, for every vertex that `eye` sees.
  struct VertexError {
    std::uint32_t vertex_idx;
    Eigen::Vector2f uv;
    double squared;
  };
  [[nodiscard]] std::vector<VertexError> errors(const fitting::PatchLightField& model,
                                                const Eigen::Vector3f& eye) const;

 private:
  struct Sight {
    std::uint32_t vertex_idx;
    Eigen::Vector2f uv;
    Eigen::Vector3f colour;
  };
  [[nodiscard]] std::vector<Sight> sights(const Eigen::Vector3f& eye) const;

  core::Mesh mesh_;
  core::RayCaster caster_;
  std::vector<core::TangentFrame> frames_;
  std::vector<Lumisphere> radiance_;
};

}  // namespace sheen::evaluation
