// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "fitting/heights/seen_texels.h"

#include <functional>
#include <span>

namespace sheen::fitting::heights {

/// Moves the vertices of a mesh along their normals to where the pictures of its print agree: a
/// print on a surface that lies a height h off is seen displaced by the parallax of h, another way
/// from every direction. docs/algorithm.md, "Heights".
struct HeightRefinement {
  bool is_accepted = false;
  core::Mesh mesh;  ///< refined where accepted, else as given
  /// Mean squared difference of the check views to the mean picture of the others, over channels,
  /// steps of 255, less what it is over a whole neighbourhood of a view (gloss); 0 where no check
  /// view shows anything that they show.
  double residual_before = 0, residual_after = 0;
  double median_m = 0;  ///< of the heights' magnitudes, over the positions that were seen

  [[nodiscard]] double change() const {
    return residual_before > 0 ? residual_after / residual_before - 1 : 0;
  }
};

/// Outlines of a mesh that was measured from them keep their places, to about half a pixel; those
/// of a mesh that was given may move with the shape as a whole where that is clearly better.
enum class Outlines { stay, may_move };

/// The residual must fall by this part for heights to be accepted.
inline constexpr double kLeastFall = 0.015;

/// Fall of the residual for which outlines are let go, or the mesh is moved as a whole. What gloss
/// and poses make of right meshes stays below a third of it.
inline constexpr double kClearFall = 0.025;

/// Estimates heights from `views` and accepts them when the residual on `check_views`, which have
/// no part in the estimate, falls by at least kLeastFall. `texel_m` > 0 is what a pixel covers on
/// the surface. Positions that fewer than two views show do not move. Calls `progress(done, all)`
/// before each view of each pass; what it throws comes out. The same on any number of threads.
HeightRefinement refine_heights(const core::Mesh& mesh, std::span<const PosedImage> views,
                                std::span<const PosedImage> check_views, float texel_m,
                                Outlines outlines, int threads,
                                const std::function<void(int done, int all)>& progress = {});

/// HeightRefinement::residual_before alone.
double print_residual(const core::Mesh& mesh, std::span<const PosedImage> views,
                      std::span<const PosedImage> check_views, float texel_m, int threads);

}  // namespace sheen::fitting::heights
