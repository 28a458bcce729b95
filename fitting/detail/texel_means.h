// SPDX-License-Identifier: MIT
#pragma once

#include "core/atlas/atlas.h"
#include "core/mesh/mesh.h"
#include "core/samples/observation.h"
#include "fitting/detail/surface_texels.h"
#include "fitting/detail/view_raster.h"
#include "fitting/detail/texture_solver.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace sheen::fitting::detail {

/// The colours that views showed at a texel's place: weighted sums, the weight the squared cosine q
/// between normal and view, because what is seen obliquely is seen unsharply. Integers, so that they
/// do not depend on the order of the views.
struct alignas(16) TexelMean {
  std::uint32_t weight = 0;               ///< sum of q, in 64ths
  std::array<std::uint32_t, 3> colour{};  ///< sum of q times the colour, RGB, in 1020ths
};

/// What one view shows of a triangle: the normal equations of three colours at its corners that are
/// interpolated in between.
struct TriangleColours {
  float texels = 0;                         ///< seen
  std::array<float, 6> matrix{};            ///< sums of w_i w_j: 00 11 22 01 12 20
  std::array<std::array<float, 3>, 3> colour{};  ///< corner by corner, sum of w_i f, f in 0 to 255
};

/// The mean colour of every texel over all views so far.
class TexelMeans {
 public:
  /// Texels are sent to a renderer in square pages of this side.
  static constexpr int kPage = 64;

  /// `mesh` and `atlas`, one of its, outlive it.
  TexelMeans(const core::Mesh& mesh, const core::Atlas& atlas, int threads);

  /// Adds a view. The same on any number of threads.
  void integrate(const core::Observation& observation, const ViewRaster& raster);

  [[nodiscard]] const std::vector<TexelMean>& texels() const { return means_; }
  [[nodiscard]] const SurfaceTexels& surface() const { return surface_; }
  /// Of the last view, one for each triangle.
  [[nodiscard]] const std::vector<TriangleColours>& triangles() const { return triangles_; }

  const Planes* subtract = nullptr;  // LAB

 private:
  const core::Mesh& mesh_;
  int threads_;
  SurfaceTexels surface_;
  std::vector<TexelMean> means_;
  std::vector<TriangleColours> triangles_;
};

}  // namespace sheen::fitting::detail
