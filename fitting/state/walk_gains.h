// SPDX-License-Identifier: MIT
#pragma once

#include "core/samples/sample_batch.h"

#include <array>
#include <cstddef>
#include <vector>

namespace sheen::fitting {

/// What exposure and white balance multiply light with, per channel r, g, b.
using Gain = std::array<double, 3>;
inline constexpr Gain kNoGain{1, 1, 1};

/// Multiplies the light of all samples: colours are taken to linear light and back, at most 1.
/// Light that is multiplied by 1 keeps its bits.
void multiply_light(const Gain& gain, core::SampleBatch& batch);

/// Gains of walks round one object, from what they show in common: the same patch from the same
/// cell of directions (guidance/direction_cells.h). docs/algorithm.md, section 13.
class WalkGains {
 public:
  /// At most some two thousand of the patches are looked at, spread evenly.
  WalkGains(std::size_t walk_count, std::size_t patch_count);

  /// A view of a walk, < walk_count. Values near black or white say nothing about a gain.
  void add(std::size_t walk, const core::SampleBatch& batch);

  /// Light of a walk by light of the one with the most views (the first of those), or where no
  /// overlap leads to that one, of the one with the most views that it leads to; exactly 1 for
  /// equal walks.
  [[nodiscard]] std::vector<Gain> estimate() const;

 private:
  struct Cell {
    std::array<float, 3> sum{};  ///< of linear light
    std::array<float, 3> count{};
    [[nodiscard]] double mean(std::size_t channel) const {
      return static_cast<double>(sum.at(channel)) / static_cast<double>(count.at(channel));
    }
  };
  [[nodiscard]] std::vector<double> log_ratios(std::size_t a, std::size_t b,
                                               std::size_t channel) const;

  std::size_t stride_;
  std::size_t cells_each_;  ///< of a walk
  std::vector<std::size_t> views_;
  std::vector<Cell> cells_;
};

}  // namespace sheen::fitting
