// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

namespace sheen::fitting::eigen_texture {

/// One channel's deviations from the mean as basis * coefficients^T: texels x bases, views x bases.
struct Factors {
  Eigen::MatrixXf basis;
  Eigen::MatrixXf coefficients;

  [[nodiscard]] Eigen::Index rank() const { return basis.cols(); }
  void truncate(Eigen::Index rank);
};

/// The same product with coefficients that are uncorrelated and have mean square 1, and bases that
/// are orthogonal, the longest first: the best `rank` ones of the product's singular value
/// decomposition. Fewer where it has no more.
Factors canonical(const Factors& factors, Eigen::Index rank);

/// How many bases each channel gets of `total`: the next one goes to where its mean square over the
/// texels, times kChannelWeight, is largest. None is given out that changes less than a hundredth
/// of a grey level.
std::array<Eigen::Index, 3> give_out_bases(const std::array<Factors, 3>& channels,
                                           std::size_t total);

/// Deviations of some texels (rows) in some views (columns) and what they count for, 0 where a
/// texel was not seen.
struct Deviations {
  Eigen::MatrixXf value;
  Eigen::MatrixXf weight;

  [[nodiscard]] float noise_of(const Factors& factors) const;
};

/// Coefficients of one view that explain seen deviations best, by probabilistic PCA (Tipping and
/// Bishop 1999): min sum w (x - b.c)^2 + noise c.c. `basis` has a row per seen texel.
Eigen::VectorXf explain(const Eigen::MatrixXf& basis, const Eigen::VectorXf& value,
                        const Eigen::VectorXf& weight, float noise);

/// `explain` for every view (column).
Eigen::MatrixXf explain_all(const Eigen::MatrixXf& basis, const Deviations& deviations, float noise,
                            int threads);

/// Bases by `sweeps` of expectation maximisation over what was seen: holes never count. The same on
/// any number of threads.
Factors factorise(const Deviations& deviations, Eigen::Index rank, int sweeps, int threads);

/// A texel's row of the bases: min sum w (x - b.c)^2 + sum ridge_k b_k^2 over its views.
/// `coefficients` has a row per view that saw it.
Eigen::VectorXf regress(const Eigen::MatrixXf& coefficients, const Eigen::VectorXf& value,
                        const Eigen::VectorXf& weight, const Eigen::VectorXf& ridge);

/// The ridge of `regress` when bases have the lengths that `factors` have: noise over mean square.
Eigen::VectorXf ridge_of(const Factors& factors, float noise);

}  // namespace sheen::fitting::eigen_texture
