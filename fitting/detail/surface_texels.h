// SPDX-License-Identifier: MIT
#pragma once

#include "core/atlas/atlas.h"
#include "fitting/detail/four.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sheen::fitting::detail {

/// A texel and the place on its triangle where the surface is nearest to its centre.
struct SurfaceTexel {
  std::uint32_t texel_idx;    ///< row * width + column
  float at_second, at_third;  ///< weights of the triangle's second and third corner
};

/// Weights of a triangle's corners at four of its texels, the first of which is given. Three more
/// follow the last texel of a mesh.
SHEEN_INLINE FourWeights weights_of_four(const SurfaceTexel* first) {
  const Four second{first[0].at_second, first[1].at_second, first[2].at_second, first[3].at_second};
  const Four third{first[0].at_third, first[1].at_third, first[2].at_third, first[3].at_third};
  return {1.0f - second - third, second, third};
}

/// Every texel that a bilinear reading somewhere on the surface touches, with the one triangle it
/// belongs to: the one that covers its centre or comes nearest to it.
class SurfaceTexels {
 public:
  explicit SurfaceTexels(const core::Atlas& atlas);

  [[nodiscard]] std::size_t size() const { return offsets_.back(); }
  /// Texels of all triangles before this one.
  [[nodiscard]] std::size_t before(std::size_t triangle_idx) const {
    return offsets_[triangle_idx];
  }
  /// Those of a triangle.
  [[nodiscard]] std::span<const SurfaceTexel> of(std::size_t triangle_idx) const {
    return {texels_.data() + offsets_[triangle_idx],
            offsets_[triangle_idx + 1] - offsets_[triangle_idx]};
  }

 private:
  std::vector<std::uint32_t> offsets_;
  std::vector<SurfaceTexel> texels_;  ///< and three more, to be read and not used
};

}  // namespace sheen::fitting::detail
