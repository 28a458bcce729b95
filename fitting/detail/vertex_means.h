// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "core/samples/sample_batch.h"
#include "fitting/detail/texel_means.h"

#include <cstdint>
#include <span>
#include <vector>

namespace sheen::fitting::detail {

/// The colour of a view round every vertex: mean over the pixels of the triangles there, each
/// weighted with the vertex's barycentric weight. What lies between vertices averages out of it,
/// and with it what small errors of pose and mesh make of print; a texture that has the print needs
/// from the vertices only what changes with direction.
class VertexMeans {
 public:
  explicit VertexMeans(const core::Mesh& mesh);

  /// Replaces the colours of a view's samples by means. `triangles` has an entry per triangle.
  /// Samples whose surroundings are partly hidden are dropped; those whose surroundings are smaller
  /// than a pixel stay as they are.
  void average(std::span<const TriangleColours> triangles, core::SampleBatch& samples);

 const std::vector<Eigen::Vector3f>* subtract = nullptr;
 private:
  struct Corner {
    std::uint32_t triangle_idx;
    std::uint32_t corner;
  };

  struct Sum { Eigen::Vector3f g; float lumped; };
  std::vector<Eigen::Vector3f> value_, next_;
  const core::Mesh& mesh_;
  std::vector<std::uint32_t> offsets_;
  std::vector<Corner> corners_;  ///< those at vertex i: [offsets_[i], offsets_[i + 1])
};

}  // namespace sheen::fitting::detail
