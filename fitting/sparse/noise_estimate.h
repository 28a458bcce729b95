// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace sheen::fitting::sparse {

/// The camera's noise, from samples that were taken of the same patch from nearly the same
/// direction: the median of their differences, so that highlights' edges and outliers do not count.
/// Sums of counts: parts may be collected anywhere and added in any order.
class NoiseEstimate {
 public:
  /// Difference of a sample from an equally noisy one of its direction: root mean square over the
  /// channels, in units of one sample's noise (SampleStore::Arrival). >= 0.
  void add(float difference);
  void add(const NoiseEstimate& other);

  /// Standard deviation of a sample's noise per channel, sRGB; nothing with too few differences to
  /// tell.
  [[nodiscard]] std::optional<float> deviation() const;

 private:
  static constexpr std::size_t kBins = 128;
  std::array<std::uint64_t, kBins> count_{};
};

}  // namespace sheen::fitting::sparse
