// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace sheen::fitting::multi_eigenspace {

/// Inner products of all pictures, divided by the pixels and channels that count, so that squared
/// distances are mean squared differences in grey levels.
using Gram = Eigen::MatrixXd;

/// The principal axes of some views' pictures, from inner products alone: with the eigenvectors v_k
/// and eigenvalues l_k of the centred Gram matrix of the members, eigenimage k is
/// sum_i v_ik / sqrt(l_k) x_i.
struct ViewGroup {
  std::vector<std::uint32_t> members;  ///< ascending
  Eigen::MatrixXd combinations;        ///< [member][eigenimage]: v_ik / sqrt(l_k)
  Eigen::VectorXd residuals;           ///< of the members, mean squared, grey levels^2
  Eigen::VectorXd with_mean;           ///< inner products of the members with their mean
  double mean_square = 0;              ///< of the mean with itself

  [[nodiscard]] int dimensions() const { return static_cast<int>(combinations.cols()); }
  /// Mean squared error of any view drawn with these eigenimages.
  [[nodiscard]] double residual(const Gram& gram, std::uint32_t view_idx) const;
  /// Its coefficients.
  [[nodiscard]] Eigen::VectorXd coefficients(const Gram& gram, std::uint32_t view_idx) const;
};

/// Axes of a group that is not empty: the fewest with which the mean squared error stays within
/// `allowed`, `most` where it does not.
ViewGroup principal_axes(const Gram& gram, std::vector<std::uint32_t> members, int most,
                         double allowed);

}  // namespace sheen::fitting::multi_eigenspace
