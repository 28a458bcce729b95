// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/eigen_texture/texel_reader.h"

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <vector>

namespace sheen::fitting::eigen_texture {

/// Resampled views, at most so many: one more than that, and the two whose directions lie nearest
/// together become one. Bases are linear, so what both show is explained by the mean of their
/// coefficients as it was by each of them; only what one of them alone shows is now taken to be
/// seen from between the two. So memory is bounded, whatever the length of the recording, and the
/// views that stay are spread evenly over the directions it was taken from.
class MergingViews {
 public:
  explicit MergingViews(std::size_t most) : most_(most) {}

  /// `texels` by slot; `direction`: unit vector from the object's centre to the camera.
  void add(std::vector<SeenTexel> texels, const Eigen::Vector3f& direction);

  /// In the order in which the first of each came.
  [[nodiscard]] std::span<const std::vector<SeenTexel>> texels() const { return texels_; }
  /// Unit vectors, one for each.
  [[nodiscard]] const std::vector<Eigen::Vector3f>& directions() const { return directions_; }

 private:
  void merge_nearest();

  std::size_t most_;
  std::vector<std::vector<SeenTexel>> texels_;
  std::vector<Eigen::Vector3f> directions_;
  std::vector<float> counts_;  ///< views that each was made of
};

/// What two views show together, by slot: of texels that both show means, `share` of them the
/// second one's, in [0, 1].
std::vector<SeenTexel> merged(const std::vector<SeenTexel>& first,
                              const std::vector<SeenTexel>& second, float share);

}  // namespace sheen::fitting::eigen_texture
