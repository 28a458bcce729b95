// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/iwls/polynomial.h"
#include "fitting/iwls/wendland.h"
#include "fitting/samples/sample.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace sheen::fitting::iwls {

/// Everything a weighted fit at one node needs to know about the samples in its support (eq. 2):
/// A = sum theta b b^T, g = sum theta b f^T and the number of samples. For a fixed centre and
/// radius these sums are equivalent to the list of samples itself.
template <std::size_t kTerms>
struct NormalEquations {
  /// Upper triangle of A, column by column: the first m (m + 1) / 2 entries are the system of the
  /// first m terms.
  std::array<double, kTerms*(kTerms + 1) / 2> A{};
  std::array<double, 3 * kTerms> g{};  ///< [term][r, g, b]
  double count = 0;

  /// Sum of the weights.
  [[nodiscard]] double weight() const { return A[0]; }

  /// (x, y) = (sample - node) / radius; theta its weight.
  void add(double x, double y, double theta, const Rgb& rgb) {
    const auto b = basis<kTerms>(x, y);
    std::size_t entry = 0;
    for (std::size_t col = 0; col < kTerms; ++col) {
      const double weighted = theta * b[col];
      for (std::size_t row = 0; row <= col; ++row) A[entry++] += weighted * b[row];
      for (std::size_t i = 0; i < 3; ++i) g[3 * col + i] += weighted * rgb[i];
    }
    count += 1;
  }
};

/// Where a system stands on the disc. Samples at the radius itself weigh nothing and are outside.
struct Node {
  double u = 0, v = 0;
  double radius = 1;
};

/// Adds the sample when the node's support holds it; returns whether it does.
template <std::size_t kTerms>
bool add_if_covered(const Node& node, const Sample& sample, NormalEquations<kTerms>& sums) {
  const double x = (sample.u - node.u) / node.radius;
  const double y = (sample.v - node.v) / node.radius;
  const double distance2 = x * x + y * y;
  if (distance2 >= 1.0) return false;
  sums.add(x, y, wendland(std::sqrt(distance2)), sample.rgb);
  return true;
}

}  // namespace sheen::fitting::iwls
