// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/sparse/columns.h"
#include "fitting/sparse/sample_pool.h"

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace sheen::fitting::sparse {

/// Most samples a patch may keep.
inline constexpr std::size_t kMaxStoredSamples = kColumnRows;

/// A direction and the colour seen from it, in single precision.
struct DirectedColour {
  Eigen::Vector2f uv;   ///< on the unit disc
  Eigen::Vector3f rgb;  ///< sRGB
};

/// Root mean square over the channels.
inline float size_of(const Eigen::Vector3f& difference) {
  return std::sqrt(difference.squaredNorm() / 3.0f);
}

/// The samples of one patch, bounded in number. No two of them are nearer to each other than the
/// store's spacing, about a degree at first: what comes nearer is averaged into what is there, so
/// that a camera at 30 frames per second mostly merges. When the store is full its spacing grows
/// until some merge: what is kept stays spread out, extremes included, and the noise of what is
/// given up still averages out. 36 bytes, and 12 for each sample in the pool, in blocks of sixteen.
class SampleStore {
 public:
  /// What became of a sample.
  struct Arrival {
    std::size_t idx;     ///< where it is kept now
    bool merged;         ///< averaged into one that was there
    float disagreement;  ///< if merged: distance in colour from what was there, in units of the
                         ///< noise of one sample
  };

  /// Colours are limited to [-0.5, 1.5]. 2 <= max_samples <= kMaxStoredSamples, the same in every
  /// call. Takes at most one block from the pool.
  Arrival add(const DirectedColour& sample, std::size_t max_samples, SamplePool& pool);

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] DirectedColour at(std::size_t idx, const SamplePool& pool) const;
  [[nodiscard]] Eigen::Vector2f direction(std::size_t idx, const SamplePool& pool) const;
  /// Samples that were averaged into this one, 1 to 255.
  [[nodiscard]] float count(std::size_t idx, const SamplePool& pool) const;
  /// Reads all of them; `samples` has room for kMaxStoredSamples.
  std::span<const DirectedColour> read(const SamplePool& pool,
                                       std::span<DirectedColour> samples) const;

  /// How far off the prediction was that was made without the sample; kept to about 4 %.
  void set_normalised_residual(std::size_t idx, float normalised_residual, SamplePool& pool) const;
  [[nodiscard]] float normalised_residual(std::size_t idx, const SamplePool& pool) const;

  /// Squared distances of all samples from a direction, in disc units; returns the nearest.
  std::size_t distances(const Eigen::Vector2f& uv, const SamplePool& pool,
                        std::span<float> squared) const;

 private:
  static constexpr std::size_t kBlocks = kMaxStoredSamples / SampleBlock::kSamples;

  [[nodiscard]] SampleBlock& block_of(std::size_t idx, SamplePool& pool) const {
    return pool[block_[idx / SampleBlock::kSamples]];
  }
  [[nodiscard]] const SampleBlock& block_of(std::size_t idx, const SamplePool& pool) const {
    return pool[block_[idx / SampleBlock::kSamples]];
  }
  [[nodiscard]] bool is_near(std::size_t idx, const Eigen::Vector2f& uv,
                             const SamplePool& pool) const;
  Arrival merge(std::size_t idx, const DirectedColour& sample, unsigned count, SamplePool& pool);
  void put(std::size_t idx, const DirectedColour& sample, unsigned count, SamplePool& pool) const;
  void move(std::size_t from, std::size_t to, SamplePool& pool) const;
  void make_room(SamplePool& pool);

  std::array<std::uint32_t, kBlocks> block_{};
  std::uint8_t size_ = 0;
  std::uint8_t latest_ = 0;   // where the last sample went: where the next one is likely to go
  std::uint8_t spacing_ = 0;  // in steps
};

}  // namespace sheen::fitting::sparse
