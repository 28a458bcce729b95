// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/detail/anchored_offsets.h"
#include "fitting/detail/check_directions.h"
#include "fitting/detail/patch_kernels.h"
#include "fitting/detail/triangle_samples.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

namespace sheen::fitting::detail {

/// Levels of anchors, coarse to fine.
inline constexpr std::size_t kAnchorLevels = 2;

/// Samples of all triangles, and what anchors leave of their differences from the triangles' means.
/// Number by number, of every triangle whole groups of sparse::kRowGroup: those behind its samples
/// weigh nothing. Takes 52 bytes a sample.
class AnchorResiduals {
 public:
  /// Of no anchors. `samples` outlives it.
  AnchorResiduals(const TriangleSamples& samples, FittedDirections fitted, int threads);

  /// After the anchors of a level have changed; returns the weighted sum of squares. The same on
  /// any number of threads.
  double update(const AnchoredOffsets& anchors, std::size_t level);

  /// A triangle's samples.
  struct Rows {
    DirectionRows w;
    const float* weight;
    std::array<const float*, 3> left;
  };
  [[nodiscard]] Rows of(std::size_t triangle) const;

 private:
  using Numbers = std::vector<float>;
  using Colours = std::array<Numbers, 3>;

  void append(const TriangleSample& sample);
  [[nodiscard]] DirectionRows directions(std::size_t triangle) const;
  double update(const AnchoredOffsets& anchors, std::size_t level, std::size_t triangle);

  const TriangleSamples& samples_;
  int threads_;
  std::vector<std::size_t> first_;
  Numbers x_, y_, z_, weight_;
  Colours left_;
  std::array<Colours, kAnchorLevels> said_;  ///< by the anchors of a level
};

}  // namespace sheen::fitting::detail
