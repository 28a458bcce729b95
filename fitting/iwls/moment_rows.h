// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace sheen::fitting::iwls {

/// How the moments of a quad lie in memory, one row of four lanes each. With F = terms - 1
/// features (the basis but its constant): weight; mean colour; mean features; centred second
/// moments of the features, lower triangle; centred moments of features and colour [feature][r, g,
/// b]; number of samples. Whole cache lines; the first holds what a split node is asked for.
template <std::size_t kTerms>
struct MomentRows {
  static constexpr std::size_t kFeatures = kTerms - 1;
  static constexpr std::size_t kWeight = 0;
  static constexpr std::size_t kColour = 1;
  static constexpr std::size_t kMean = 4;
  static constexpr std::size_t kSecond = kMean + kFeatures;
  static constexpr std::size_t kMixed = kSecond + kFeatures * (kFeatures + 1) / 2;
  static constexpr std::size_t kCount = kMixed + 3 * kFeatures;
  static constexpr std::size_t kRows = (kCount + 1 + 3) / 4 * 4;
};

}  // namespace sheen::fitting::iwls
