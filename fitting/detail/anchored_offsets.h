// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/tangent_frame.h"
#include "core/mesh/mesh.h"
#include "fitting/detail/anchor_layout.h"
#include "fitting/sparse/light_field_model.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sheen::fitting::detail {

/// Where a vertex asks an anchor for its value: in the direction in which it is seen itself, or in
/// the one in which the anchor mirrors the same light. With n the vertex's normal, n_a the anchor's
/// and w the direction, r = 2 (n . w) n - w and w_a = 2 (n_a . r) n_a - r.
enum class AskedDirection { same, mirrored };

/// Anchors of a mesh: vertices as far apart as `spacing_m` (anchor_layout.h).
struct AnchorLayout {
  std::vector<std::uint32_t> vertices;  ///< ascending
  float spacing_m = 1;
};

/// How colours change with the direction, known at anchors and blended in between.
class AnchoredOffsets {
 public:
  /// `models` has a patch per anchor, in its vertex's frame; those of one term are zero.
  AnchoredOffsets(const core::Mesh& mesh, AnchorLayout layout, AskedDirection asked,
                  sparse::LightFieldModel models);

  [[nodiscard]] const AnchorLayout& layout() const { return layout_; }
  [[nodiscard]] AskedDirection asked() const { return asked_; }
  [[nodiscard]] const sparse::LightFieldModel& models() const { return models_; }
  [[nodiscard]] sparse::LightFieldModel& models() { return models_; }
  /// Of every vertex of the mesh.
  [[nodiscard]] const std::vector<AnchorBlend>& blends() const { return blends_; }
  [[nodiscard]] const Eigen::Vector3f& normal(std::size_t vertex) const { return normals_[vertex]; }

  /// Offset of a vertex towards `uv` on its disc.
  [[nodiscard]] Eigen::Vector3f colour(std::size_t vertex, const Eigen::Vector2f& uv) const;

  /// Direction in which an anchor is asked by a vertex that is seen from `uv`, on the anchor's
  /// disc.
  [[nodiscard]] Eigen::Vector2f uv_at(std::size_t anchor, std::size_t vertex,
                                      const Eigen::Vector2f& uv) const;

 private:
  AnchorLayout layout_;
  AskedDirection asked_;
  sparse::LightFieldModel models_;
  std::vector<AnchorBlend> blends_;
  std::vector<Eigen::Vector3f> normals_;  ///< of the vertices
};

}  // namespace sheen::fitting::detail
