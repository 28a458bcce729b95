// SPDX-License-Identifier: MIT
#include "fitting/multi_eigenspace/view_group.h"

#include "fitting/multi_eigenspace/in_steps.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace sheen::fitting::multi_eigenspace {
namespace {

Eigen::VectorXd products_with(const Gram& gram, const std::vector<std::uint32_t>& members,
                              std::uint32_t view_idx) {
  Eigen::VectorXd products(static_cast<Eigen::Index>(members.size()));
  for (std::size_t i = 0; i < members.size(); ++i) {
    products[static_cast<Eigen::Index>(i)] = gram(members[i], view_idx);
  }
  return products;
}

}  // namespace

Eigen::VectorXd ViewGroup::coefficients(const Gram& gram, std::uint32_t view_idx) const {
  // The combinations of an eigenimage sum to zero, so the view need not be centred.
  return combinations.transpose() * (products_with(gram, members, view_idx) - with_mean);
}

double ViewGroup::residual(const Gram& gram, std::uint32_t view_idx) const {
  const Eigen::VectorXd products = products_with(gram, members, view_idx);
  const double from_mean = gram(view_idx, view_idx) - 2 * products.mean() + mean_square;
  const double held = (combinations.transpose() * (products - with_mean)).squaredNorm();
  return in_steps(std::max(from_mean - held, 0.0), kErrorBits);
}

ViewGroup principal_axes(const Gram& gram, std::vector<std::uint32_t> members, int most,
                         double allowed) {
  const auto count = static_cast<Eigen::Index>(members.size());
  Eigen::MatrixXd own(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    own.col(i) = products_with(gram, members, members[static_cast<std::size_t>(i)]);
  }
  ViewGroup group;
  group.members = std::move(members);
  group.with_mean = own.rowwise().mean();
  group.mean_square = group.with_mean.mean();
  own.colwise() -= group.with_mean;
  own.rowwise() -= group.with_mean.transpose();
  own.array() += group.mean_square;

  // Eigenvalues rise; what is nothing but rounding is no axis.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(own);
  constexpr double rounding = 1e-9;
  const double largest =
      std::max(axes.eigenvalues()[count - 1], gram.diagonal().maxCoeff() * rounding);
  const auto spread = [&](Eigen::Index k) { return axes.eigenvalues()[count - 1 - k]; };
  double left = std::max(own.trace(), 0.0);
  Eigen::Index used = 0;
  while (used < std::min<Eigen::Index>(most, count - 1) &&
         in_steps(left, kErrorBits) > allowed * static_cast<double>(count) &&
         in_steps(spread(used), kErrorBits) > rounding * largest) {
    left -= spread(used++);
  }
  group.combinations.resize(count, used);
  group.residuals = own.diagonal();
  for (Eigen::Index k = 0; k < used; ++k) {
    // The sign is free: that of the first among the strongest, equal ones of which may differ in
    // last digits.
    Eigen::VectorXd axis = axes.eigenvectors().col(count - 1 - k);
    constexpr double nearly = 1 - 1e-6;
    const double strong = nearly * axis.cwiseAbs().maxCoeff();
    const auto first = std::ranges::find_if(axis, [&](double x) { return std::abs(x) >= strong; });
    if (*first < 0) axis = -axis;
    group.combinations.col(k) = axis / std::sqrt(spread(k));
    group.residuals -= spread(k) * axis.cwiseAbs2();
  }
  for (double& residual : group.residuals) residual = in_steps(std::max(residual, 0.0), kErrorBits);
  return group;
}

}  // namespace sheen::fitting::multi_eigenspace
