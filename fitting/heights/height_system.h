// SPDX-License-Identifier: MIT
#pragma once

#include "core/atlas/atlas.h"
#include "core/mesh/mesh.h"
#include "fitting/detail/surface_texels.h"
#include "fitting/heights/height_field.h"
#include "fitting/heights/seen_texels.h"
#include "fitting/heights/texel_statistics.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sheen::fitting::heights {

/// What is supposed of heights before views are looked at.
struct HeightPrior {
  double slope;             ///< expected along an edge, > 0
  Eigen::VectorXd outline;  ///< what keeps a height at 0, of each, >= 0, 1 / m^2
};

/// The least squares whose solution is the next step s of all heights h:
///
///     1 / variance  sum_x sum_views q |e - sum_i b_i k_i s_i g . o|^2
///       + sum_edges ((h_i + s_i - h_j - s_j) / (slope length))^2 + sum_i outline_i (h_i + s_i)^2
///
/// over texels x at barycentric weights b, e the difference of what a view shows to the mean, k_i
/// the cosine between a height's direction and its triangle's normal, g the gradient of the mean
/// picture less its own mean over the neighbourhood: gloss that brightens the neighbourhood in a
/// view, with which a gradient all over it could be confused, cancels out.
class HeightSystem {
 public:
  /// `planes` and `texels` are those of the mesh as `field` raises it now; neighbourhoods reach
  /// over `edges` (local_sums.h).
  HeightSystem(const HeightField& field, const core::Mesh& mesh,
               std::span<const TrianglePlane> planes, const detail::SurfaceTexels& surface,
               const core::Atlas& atlas, std::span<const TexelStatistics> texels, int edges,
               int threads);

  /// 1 for every height that some view says something about.
  [[nodiscard]] std::vector<std::uint8_t> seen() const;

  /// The next step, metres, none longer than `longest_m`; 0 for heights that are not seen.
  [[nodiscard]] Eigen::VectorXd step(const HeightPrior& prior, double longest_m) const;

 private:
  /// Normal equations of a triangle's corners: 00, 11, 22, 01, 12, 20 and the right side.
  struct TriangleEquations {
    std::array<double, 6> matrix{};
    std::array<double, 3> right{};
    double scatter = 0, weight = 0;
  };

  /// Weighted sums of the gradient, object frame, 1 / m, a column per channel; weight last.
  using GradientSums = Eigen::Matrix<float, 10, 1>;

  [[nodiscard]] GradientSums gradients_of(std::size_t triangle_idx) const;
  [[nodiscard]] TriangleEquations equations_of(std::size_t triangle_idx,
                                               std::span<const GradientSums> around) const;

  const HeightField& field_;
  const core::Mesh& mesh_;
  std::span<const TrianglePlane> planes_;
  const detail::SurfaceTexels& surface_;
  const core::Atlas& atlas_;
  std::span<const TexelStatistics> texels_;
  std::vector<TriangleEquations> equations_;
  double variance_ = 0;
};

}  // namespace sheen::fitting::heights
