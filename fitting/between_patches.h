// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include <cstddef>

namespace sheen::fitting {

/// What a light field of patches adds, at every place of the surface, to what its patches
/// interpolate to: more than a texture where it depends on the direction.
class BetweenPatches {
 public:
  virtual ~BetweenPatches() = default;

  /// Colour added at a place on a triangle towards `w`, unit vector in the object frame.
  [[nodiscard]] virtual Eigen::Vector3f between_patches(std::size_t triangle_idx,
                                                        const Eigen::Vector3f& barycentric,
                                                        const Eigen::Vector3f& w) const = 0;
};

}  // namespace sheen::fitting
