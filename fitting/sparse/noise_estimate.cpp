// SPDX-License-Identifier: MIT
#include "fitting/sparse/noise_estimate.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sheen::fitting::sparse {
namespace {

// Bins a ninth of a factor two wide from 2^-14 on: a difference is known to 4 %.
constexpr float kLeast = 1.0f / 16384.0f;
constexpr float kBinsPerOctave = 9.0f;
// The median of m differences is off by 1.25 / sqrt(m) of their spread.
constexpr std::uint64_t kFewest = 1000;
// Median root mean square of three independent normal numbers of deviation 1: sqrt(2.366 / 3), from
// the median of chi squared with three degrees of freedom.
constexpr float kMedianOfThree = 0.888f;

}  // namespace

void NoiseEstimate::add(float difference) {
  const float octaves = std::log2(std::max(difference, kLeast) / kLeast);
  ++count_[std::min(kBins - 1, static_cast<std::size_t>(kBinsPerOctave * octaves))];
}

void NoiseEstimate::add(const NoiseEstimate& other) {
  for (std::size_t bin = 0; bin < kBins; ++bin) count_[bin] += other.count_[bin];
}

std::optional<float> NoiseEstimate::deviation() const {
  const std::uint64_t total = std::accumulate(count_.begin(), count_.end(), std::uint64_t{0});
  if (total < kFewest) return std::nullopt;
  std::uint64_t below = 0;
  std::size_t bin = 0;
  while (2 * (below + count_[bin]) < total) below += count_[bin++];
  const float middle = kLeast * std::exp2((static_cast<float>(bin) + 0.5f) / kBinsPerOctave);
  return middle / kMedianOfThree;
}

}  // namespace sheen::fitting::sparse
