// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/tangent_frame.h"
#include "core/mesh/mesh.h"
#include "fitting/detail/anchor_layout.h"
#include "fitting/detail/patch_kernels.h"
#include "fitting/sparse/light_field_model.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sheen::fitting::detail {

/// Where a place on the surface asks an anchor for its value: in the direction in which it is seen
/// itself, or in the one in which the anchor mirrors the same light. With n the place's normal, n_a
/// the anchor's and w the direction, r = 2 (n . w) n - w and w_a = 2 (n_a . r) n_a - r.
enum class AskedDirection { same, mirrored };

/// Anchors of a mesh: vertices as far apart as `spacing_m` (anchor_layout.h).
struct AnchorLevel {
  std::vector<std::uint32_t> vertices;  ///< ascending
  float spacing_m = 1;
};

/// An anchor that the corners of a triangle blend, with these weights.
struct CornerWeights {
  std::uint32_t anchor;
  std::array<float, 3> weight;

  /// The weight at a place on the triangle.
  [[nodiscard]] float at(const Eigen::Vector3f& barycentric) const {
    return barycentric[0] * weight[0] + barycentric[1] * weight[1] + barycentric[2] * weight[2];
  }
};

/// How colours change with the direction, known at anchors and blended in between: on every level a
/// place blends what its triangle's corners do, and the levels are added up.
class AnchoredOffsets {
 public:
  /// `models` has a patch per anchor, level after level, in its vertex's frame; those of one term
  /// are zero.
  AnchoredOffsets(const core::Mesh& mesh, std::vector<AnchorLevel> levels, AskedDirection asked,
                  sparse::LightFieldModel models);

  [[nodiscard]] const core::Mesh& mesh() const { return mesh_; }
  [[nodiscard]] const std::vector<AnchorLevel>& levels() const { return levels_; }
  [[nodiscard]] AskedDirection asked() const { return asked_; }
  [[nodiscard]] const sparse::LightFieldModel& models() const { return models_; }
  [[nodiscard]] sparse::LightFieldModel& models() { return models_; }
  /// The first anchor of a level, or the number of all behind the last.
  [[nodiscard]] std::size_t first_of(std::size_t level) const { return first_[level]; }
  /// What the corners of a triangle blend, ascending.
  [[nodiscard]] std::span<const CornerWeights> blends(std::size_t triangle) const {
    return std::span(blends_).subspan(before_[triangle], before_[triangle + 1] - before_[triangle]);
  }
  [[nodiscard]] const core::TangentFrame& frame(std::size_t anchor) const {
    return frames_[anchor];
  }

  /// Offset at a place on a triangle, unit vector `w` towards the viewer.
  [[nodiscard]] Eigen::Vector3f colour(std::size_t triangle, const Eigen::Vector3f& barycentric,
                                       const Eigen::Vector3f& w) const;
  /// sum += the offsets in many directions.
  void add(std::size_t triangle, const Eigen::Vector3f& barycentric, const DirectionRows& w,
           const ColourRows& sum) const;
  /// The same for a vertex.
  void add_at(std::size_t vertex, const DirectionRows& w, const ColourRows& sum) const;
  /// The part of `add` that one level says.
  void add_level(std::size_t level, std::size_t triangle, const Eigen::Vector3f& barycentric,
                 const DirectionRows& w, const ColourRows& sum) const;
  /// Offset of a vertex towards `uv` on its disc; zero of one that no triangle uses.
  [[nodiscard]] Eigen::Vector3f colour_at(std::size_t vertex, const Eigen::Vector2f& uv) const;

  /// Direction in which an anchor is asked where the normal is `n`, on the anchor's disc.
  [[nodiscard]] Eigen::Vector2f uv_at(std::size_t anchor, const Eigen::Vector3f& n,
                                      const Eigen::Vector3f& w) const;
  /// The same for many directions.
  [[nodiscard]] AskedPatch asked_patch(std::size_t anchor, const Eigen::Vector3f& n) const {
    return {frames_[anchor], n, asked_ == AskedDirection::mirrored};
  }

 private:
  core::Mesh mesh_;
  std::vector<AnchorLevel> levels_;
  AskedDirection asked_;
  sparse::LightFieldModel models_;
  std::vector<std::size_t> first_;
  std::vector<core::TangentFrame> frames_;
  std::vector<std::uint32_t> before_;  ///< blends of all triangles before this one
  std::vector<CornerWeights> blends_;
  std::vector<std::uint32_t> corner_of_;  ///< of every vertex: 3 triangle + corner, one of them
};

}  // namespace sheen::fitting::detail
