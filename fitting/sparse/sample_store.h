// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/samples/sample.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace sheen::fitting::sparse {

/// Most samples a patch may keep.
inline constexpr std::size_t kMaxStoredSamples = 128;

/// A direction and the colour seen from it, in single precision.
struct DirectedColour {
  Eigen::Vector2f uv;   ///< on the unit disc
  Eigen::Vector3f rgb;  ///< sRGB
};

/// The samples of one patch, 12 bytes each, bounded in number: when full, the two samples closest
/// in direction are replaced by their mean, so that what is kept stays spread out, extremes
/// included, and the noise of what is given up still averages out. Empty stores own no memory.
class SampleStore {
 public:
  /// Colours are limited to [-0.5, 1.5]. 2 <= max_samples <= kMaxStoredSamples, the same in every
  /// call.
  void add(const Sample& sample, std::size_t max_samples);

  [[nodiscard]] std::size_t size() const { return samples_.size(); }
  [[nodiscard]] DirectedColour operator[](std::size_t idx) const { return samples_[idx].decoded(); }

 private:
  struct Stored {
    std::int16_t u, v;      // in 1 / 32767
    std::uint16_t r, g, b;  // in 1 / 32767, from -0.5
    std::uint16_t count;    // samples averaged here, saturating
    [[nodiscard]] DirectedColour decoded() const;
    [[nodiscard]] static Stored encoded(const DirectedColour& sample, std::uint16_t count);
    [[nodiscard]] float squared_distance(const Stored& other) const;
  };
  struct Pair {
    std::uint16_t first = 0, second = 0;
    float squared_distance = std::numeric_limits<float>::infinity();
  };

  void grow(std::size_t max_samples);
  void find_closest();
  void update_closest(std::uint16_t moved);
  [[nodiscard]] Pair nearest_to(const Stored& sample) const;
  static Stored merged(const Stored& a, const Stored& b);

  std::vector<Stored> samples_;
  Pair closest_;  // valid once the store is full
};

}  // namespace sheen::fitting::sparse
