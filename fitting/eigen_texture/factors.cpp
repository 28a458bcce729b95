// SPDX-License-Identifier: MIT
#include "fitting/eigen_texture/factors.h"

#include "core/concurrency/parallel_for.h"
#include "fitting/eigen_texture/luma_chroma.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace sheen::fitting::eigen_texture {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::MatrixXf;
using Eigen::VectorXd;
using Eigen::VectorXf;

constexpr float kLeastNoise = 1e-4f;        // squared grey levels
constexpr double kLeastMeanSquare = 1e-4;   // of a basis that is given out
constexpr double kRelativeRounding = 1e-9;  // of singular values, squared

/// (F^T W F + diag(ridge))^-1 F^T W x.
VectorXf ridge_regression(const MatrixXf& rows, const VectorXf& value, const VectorXf& weight,
                          const VectorXf& ridge) {
  if (rows.size() == 0) return VectorXf::Zero(rows.cols());  // no bases yet, or nothing seen
  // The ridge may be ten digits below the sums.
  const MatrixXd weighted = (weight.cwiseSqrt().asDiagonal() * rows).cast<double>();
  MatrixXd normal = MatrixXd::Zero(rows.cols(), rows.cols());
  normal.selfadjointView<Eigen::Lower>().rankUpdate(weighted.transpose());
  normal.diagonal() += ridge.cast<double>();
  const VectorXd right =
      weighted.transpose() * weight.cwiseSqrt().cwiseProduct(value).cast<double>();
  const VectorXf solution =
      normal.selfadjointView<Eigen::Lower>().ldlt().solve(right).cast<float>();
  return solution.allFinite() ? solution : VectorXf::Zero(rows.cols());
}

/// What was seen of one row or column.
struct Seen {
  MatrixXf rows;
  VectorXf value, weight;
};
template <typename Values, typename Weights>
Seen seen_of(const MatrixXf& factor, const Values& value, const Weights& weight) {
  const Index count = (weight.array() > 0.0f).count();
  Seen seen{MatrixXf(count, factor.cols()), VectorXf(count), VectorXf(count)};
  for (Index i = 0, next = 0; i < factor.rows(); ++i) {
    if (!(weight[i] > 0.0f)) continue;
    seen.rows.row(next) = factor.row(i);
    seen.value[next] = value[i];
    seen.weight[next++] = weight[i];
  }
  return seen;
}

void solve_basis(const Deviations& deviations, float noise, int threads, Factors& factors) {
  const VectorXf ridge = ridge_of(factors, noise);
  core::parallel_for(static_cast<std::size_t>(factors.basis.rows()), threads,
                     [&](std::size_t begin, std::size_t end) {
                       for (auto t = static_cast<Index>(begin); t < static_cast<Index>(end); ++t) {
                         const Seen seen = seen_of(factors.coefficients, deviations.value.row(t),
                                                   deviations.weight.row(t));
                         factors.basis.row(t) = regress(seen.rows, seen.value, seen.weight, ridge);
                       }
                     });
}

/// Principal components when what was not seen is the mean.
Factors start(const Deviations& deviations, Index rank) {
  const MatrixXf filled = (deviations.weight.array() > 0.0f)
                              .select(deviations.value, MatrixXf::Zero(deviations.value.rows(),
                                                                       deviations.value.cols()));
  const Index views = filled.cols();
  return canonical({filled, MatrixXf::Identity(views, views)}, rank);
}

}  // namespace

void Factors::truncate(Index rank) {
  if (rank >= basis.cols()) return;
  basis.conservativeResize(Eigen::NoChange, rank);
  coefficients.conservativeResize(Eigen::NoChange, rank);
}

// With D^T D = S S^T, S = V sqrt(L): D S^-T has orthonormal columns, and the product is
// (M S) (D S^-T)^T. The eigenvectors of (M S)^T (M S) turn it into its singular value
// decomposition.
Factors canonical(const Factors& factors, Index rank) {
  const MatrixXd coefficients = factors.coefficients.cast<double>();
  const auto views = static_cast<double>(coefficients.rows());
  const Eigen::SelfAdjointEigenSolver<MatrixXd> inner(coefficients.transpose() * coefficients);
  const double least = kRelativeRounding * std::max(0.0, inner.eigenvalues().tail(1).sum());
  const Index kept = (inner.eigenvalues().array() > least).count();
  if (kept == 0) return {factors.basis.leftCols(0), factors.coefficients.leftCols(0)};
  const MatrixXd directions = inner.eigenvectors().rightCols(kept);
  const VectorXd lengths = inner.eigenvalues().tail(kept).cwiseSqrt();
  const MatrixXd stretched = directions * lengths.asDiagonal();

  MatrixXf inner_basis = MatrixXf::Zero(factors.basis.cols(), factors.basis.cols());
  inner_basis.selfadjointView<Eigen::Lower>().rankUpdate(factors.basis.transpose());
  const MatrixXd basis_products =
      MatrixXf(inner_basis.selfadjointView<Eigen::Lower>()).cast<double>();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> outer(stretched.transpose() * basis_products *
                                                      stretched);
  const double least_square =
      std::max(kRelativeRounding * std::max(0.0, outer.eigenvalues().tail(1).sum()), 1e-12);
  const Index found = std::min(rank, (outer.eigenvalues().array() > least_square).count());
  const MatrixXd turn = outer.eigenvectors().rightCols(found).rowwise().reverse();
  const MatrixXd to_basis = stretched * turn / std::sqrt(views);
  const MatrixXd to_coefficients =
      directions * lengths.cwiseInverse().asDiagonal() * turn * std::sqrt(views);
  return {factors.basis * to_basis.cast<float>(), (coefficients * to_coefficients).cast<float>()};
}

std::array<Index, 3> give_out_bases(const std::array<Factors, 3>& channels, std::size_t total) {
  std::array<Index, 3> given{};
  for (std::size_t i = 0; i < total; ++i) {
    std::size_t best = 0;
    double most = 0;
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const Factors& factors = channels[channel];
      if (given[channel] >= factors.rank()) continue;
      const double mean_square =
          static_cast<double>(factors.basis.col(given[channel]).squaredNorm()) /
          static_cast<double>(factors.basis.rows());
      const double gain = mean_square * static_cast<double>(kChannelWeight[channel]);
      if (mean_square < kLeastMeanSquare || gain <= most) continue;
      most = gain;
      best = channel;
    }
    if (most == 0) break;
    ++given[best];
  }
  return given;
}

float Deviations::noise_of(const Factors& factors) const {
  double sum = 0;
  for (Index v = 0; v < value.cols(); ++v) {
    const VectorXf residual =
        value.col(v) - factors.basis * factors.coefficients.row(v).transpose();
    sum += static_cast<double>(weight.col(v).dot(residual.cwiseAbs2()));
  }
  // Every number that was solved for takes a degree of freedom.
  const auto seen = static_cast<double>((weight.array() > 0.0f).count());
  const auto solved =
      static_cast<double>(factors.rank()) * static_cast<double>(value.rows() + value.cols());
  return std::max(kLeastNoise, static_cast<float>(sum / std::max(seen - solved, 0.1 * seen + 1)));
}

VectorXf explain(const MatrixXf& basis, const VectorXf& value, const VectorXf& weight,
                 float noise) {
  return ridge_regression(basis, value, weight,
                          VectorXf::Constant(basis.cols(), std::max(noise, kLeastNoise)));
}

VectorXf regress(const MatrixXf& coefficients, const VectorXf& value, const VectorXf& weight,
                 const VectorXf& ridge) {
  return ridge_regression(coefficients, value, weight, ridge);
}

VectorXf ridge_of(const Factors& factors, float noise) {
  constexpr float least_square = 1e-6f;
  const VectorXf mean_square = factors.basis.colwise().squaredNorm().transpose() /
                               static_cast<float>(std::max<Index>(1, factors.basis.rows()));
  return noise * mean_square.cwiseMax(least_square).cwiseInverse();
}

MatrixXf explain_all(const MatrixXf& basis, const Deviations& deviations, float noise,
                     int threads) {
  MatrixXf coefficients(deviations.value.cols(), basis.cols());
  core::parallel_for(
      static_cast<std::size_t>(coefficients.rows()), threads,
      [&](std::size_t begin, std::size_t end) {
        for (auto v = static_cast<Index>(begin); v < static_cast<Index>(end); ++v) {
          const Seen seen = seen_of(basis, deviations.value.col(v), deviations.weight.col(v));
          coefficients.row(v) = explain(seen.rows, seen.value, seen.weight, noise);
        }
      },
      4);
  return coefficients;
}

Factors factorise(const Deviations& deviations, Index rank, int sweeps, int threads) {
  Factors factors = start(deviations, rank);
  for (int sweep = 0; sweep < sweeps && factors.rank() > 0; ++sweep) {
    const float noise = deviations.noise_of(factors);
    factors.coefficients = explain_all(factors.basis, deviations, noise, threads);
    solve_basis(deviations, noise, threads, factors);
    factors = canonical(factors, factors.rank());
  }
  return factors;
}

}  // namespace sheen::fitting::eigen_texture
