// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/tangent_frame.h"
#include "fitting/sparse/patch_model.h"

#include <Eigen/Core>

#include <cstddef>

namespace sheen::fitting::detail {

/// Directions towards viewers, coordinate by coordinate: unit vectors, object frame. `count` is a
/// multiple of sparse::kRowGroup.
struct DirectionRows {
  const float *x, *y, *z;
  std::size_t count;
};

/// A colour for each of them.
struct ColourRows {
  float *r, *g, *b;
};

/// A patch's frame, and the normal of the place that asks it (AskedDirection).
struct AskedPatch {
  core::TangentFrame frame;
  Eigen::Vector3f normal;
  bool is_mirrored;
};

/// Every direction as the patch is asked for it, on its disc; behind the patch's horizon: on the
/// rim. The same bits on every processor, here and below.
void asked_directions(const AskedPatch& asked, const DirectionRows& w, float* u, float* v);

/// sum += weight * what the patch says in every direction.
void add_patch(const AskedPatch& asked, const sparse::PatchModel& model, float weight,
               const DirectionRows& w, const ColourRows& sum);

}  // namespace sheen::fitting::detail
