// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/multi_eigenspace/view_group.h"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace sheen::fitting::multi_eigenspace {

/// What the description of the views becomes shorter by with these groups, in units of one picture:
/// m^T Q m for the vector m of zeros and ones that says which are used. With n_j members, residuals
/// that cost x_j = sum of 1/16 log2(1 + MSE), and d_j eigenimages,
///   Q_jj = n_j - x_j - (d_j + 1) / 2,   Q_ij = -1/2 (|common members| - max(x_i, x_j) over those).
Eigen::MatrixXd description_gains(const std::vector<ViewGroup>& groups);

/// Maximises m^T Q m, Q symmetric: greedily one by one, then by exchanging one for another until
/// nothing is gained. Indices of the chosen ones, ascending; of equal gains the lowest index.
std::vector<std::size_t> maximise_boolean(const Eigen::MatrixXd& gains);

}  // namespace sheen::fitting::multi_eigenspace
