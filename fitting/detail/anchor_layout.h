// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sheen::fitting::detail {

/// Anchors that a vertex blends at most.
inline constexpr std::size_t kMostBlended = 4;

/// The nearest anchors of a vertex, nearest first, and their weights: positive, sum 1, zeros behind
/// the last; all zero where no anchor is near.
struct AnchorBlend {
  std::array<std::uint32_t, kMostBlended> anchor{};
  std::array<float, kMostBlended> weight{};
};

/// Vertices of `mesh`, ascending, no two of them nearer to each other than `spacing_m` (> 0), and
/// none of the others as far as that from all of them: a Poisson disc. Distances d are those of
/// places p and normals n: d^2 = |dp|^2 + spacing^2 |dn|^2, so that both sides of an edge have
/// anchors of their own.
std::vector<std::uint32_t> scatter_anchors(const core::Mesh& mesh, float spacing_m);

/// Whether `anchors` are vertices of `mesh`, ascending, and as far apart as that.
bool are_scattered(const core::Mesh& mesh, std::span<const std::uint32_t> anchors, float spacing_m);

/// How every vertex of `mesh` blends scattered anchors: each with the weight (1 - d / r)^2,
/// r = 3/2 spacing, divided by their sum.
std::vector<AnchorBlend> blend_anchors(const core::Mesh& mesh,
                                       std::span<const std::uint32_t> anchors, float spacing_m);

}  // namespace sheen::fitting::detail
