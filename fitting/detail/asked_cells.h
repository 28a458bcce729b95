// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/detail/anchor_residuals.h"
#include "fitting/detail/anchored_offsets.h"
#include "fitting/sparse/sample_store.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sheen::fitting::detail {

/// A triangle that blends an anchor.
struct Follower {
  std::uint32_t triangle;
  float weight;            ///< in its middle
  Eigen::Vector3f normal;  ///< there
};

/// The directions in which its followers ask an anchor, in cells of a grid over its disc: the
/// finest of which they touch no more than a given number. They stay the same while the anchor is
/// fitted.
class AskedCells {
 public:
  /// Of no anchor.
  AskedCells() = default;
  /// At most `most` cells, 4 to kMaxStoredSamples.
  AskedCells(const AnchoredOffsets& anchors, std::size_t anchor,
             std::span<const Follower> followers, const AnchorResiduals& residuals,
             std::size_t most);

  [[nodiscard]] bool empty() const { return cells_.empty(); }

  /// A sample for every cell: what the anchor says there itself and the mean of what is left, the
  /// samples of all followers weighted with the squares of theirs.
  std::span<const sparse::DirectedColour> read(const AnchoredOffsets& anchors, std::size_t anchor,
                                               std::span<const Follower> followers,
                                               const AnchorResiduals& residuals,
                                               std::span<sparse::DirectedColour> samples) const;

 private:
  struct Cell {
    float weight = 0;
    Eigen::Vector2f uv = Eigen::Vector2f::Zero();  ///< mean
  };

  void number(std::span<const Eigen::Vector2f> uvs, int grid);

  std::vector<Cell> cells_;
  std::vector<std::uint8_t> of_sample_;  ///< of the followers' rows
};

}  // namespace sheen::fitting::detail
