// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/iwls/fit_rule.h"
#include "fitting/iwls/normal_equations.h"
#include "fitting/iwls/polynomial.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

namespace sheen::fitting::iwls {

namespace detail {

// Solves the leading kSize x kSize system by L D L^T without square roots; the matrix is positive
// (semi)definite, so no pivoting is needed. Nothing when a pivot relative to its diagonal falls
// below `smallest_pivot`.
template <std::size_t kSize, std::size_t kTerms>
std::optional<Polynomial<kTerms>> solve_leading(const NormalEquations<kTerms>& system,
                                                const std::array<double, kTerms>& penalty,
                                                const Rgb& prior, double smallest_pivot) {
  std::array<std::array<double, kSize>, kSize> L{};
  std::array<double, kSize> inverse_d{};
  // Factor.
  for (std::size_t row = 0; row < kSize; ++row) {
    const double* column = system.A.data() + row * (row + 1) / 2;
    for (std::size_t col = 0; col < row; ++col) {
      double sum = column[col];
      for (std::size_t k = 0; k < col; ++k) sum -= L[row][k] * L[col][k] * inverse_d[k];
      L[row][col] = sum;  // L D for now: divided below
    }
    const double diagonal = column[row] + penalty[row];
    double pivot = diagonal;
    for (std::size_t k = 0; k < row; ++k) pivot -= L[row][k] * L[row][k] * inverse_d[k];
    if (!(pivot > smallest_pivot * diagonal)) return std::nullopt;
    inverse_d[row] = 1.0 / pivot;
  }
  // Substitute forwards and backwards, three right-hand sides at once.
  Polynomial<kTerms> c{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t row = 0; row < kSize; ++row) {
      double sum = system.g[3 * row + i] + (row == 0 ? penalty[0] * prior[i] : 0.0);
      for (std::size_t k = 0; k < row; ++k) sum -= L[row][k] * c[3 * k + i];
      c[3 * row + i] = sum * inverse_d[row];
    }
    for (std::size_t row = kSize; row-- > 0;) {
      for (std::size_t k = row + 1; k < kSize; ++k) {
        c[3 * row + i] -= L[k][row] * inverse_d[row] * c[3 * k + i];
      }
    }
  }
  return c;
}

template <std::size_t kTerms>
Polynomial<kTerms> solve_ridge(const NormalEquations<kTerms>& system, const Rgb& prior,
                               const FitRule& rule) {
  std::array<double, kTerms> penalty;
  penalty.fill(rule.ridge.relative * system.weight() + rule.ridge.absolute);
  penalty[0] = rule.ridge.value;
  // Positive penalties on every term: the factorisation cannot fail.
  if constexpr (kTerms == 6) {
    if (rule.choose_order && system.count < kSamplesPerTerm * 3) {
      return *solve_leading<1>(system, penalty, prior, 0.0);
    }
    if (rule.choose_order && system.count < kSamplesPerTerm * 6) {
      return *solve_leading<3>(system, penalty, prior, 0.0);
    }
  }
  return *solve_leading<kTerms>(system, penalty, prior, 0.0);
}

template <std::size_t kTerms>
Polynomial<kTerms> solve_faithful(const NormalEquations<kTerms>& system) {
  const std::array<double, kTerms> no_penalty{};
  if (const auto fit = solve_leading<kTerms>(system, no_penalty, Rgb{}, kSmallestPivot)) {
    return *fit;
  }
  return *solve_leading<1>(system, no_penalty, Rgb{}, 0.0);
}

}  // namespace detail

/// The polynomial of a node (eqs. 2 and 8), in the node's own coordinates. `prior` is the value it
/// takes without samples. Finite for finite sums.
template <std::size_t kTerms>
Polynomial<kTerms> fit(const NormalEquations<kTerms>& system, const Rgb& prior,
                       const FitRule& rule) {
  // A sample a hair inside the radius has a weight that all but underflows.
  constexpr double smallest_weight = 1e-100;
  if (system.weight() < smallest_weight) {
    Polynomial<kTerms> constant{};
    std::copy(prior.begin(), prior.end(), constant.begin());
    return constant;
  }
  return rule.faithful ? detail::solve_faithful(system) : detail::solve_ridge(system, prior, rule);
}

}  // namespace sheen::fitting::iwls
