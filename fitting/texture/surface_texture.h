// SPDX-License-Identifier: MIT
#pragma once

#include "core/atlas/atlas.h"

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace sheen::fitting {

/// A texel as it is stored: display-referred sRGB, 8 bits a channel, R, G, B.
using Texel = std::array<std::uint8_t, 3>;

/// What a texture takes: colours that say something of their own, of so many that readings touch.
struct TexelCount {
  std::size_t stored = 0, offered = 0;
};

/// Colours over a surface, finer than its vertices.
class SurfaceTexture {
 public:
  /// Texels are changed and sent to a renderer in square pages of this side, row by row; those at
  /// the right and lower border may be smaller.
  static constexpr int kPage = 64;

  /// Mid grey everywhere.
  explicit SurfaceTexture(core::Atlas atlas);

  [[nodiscard]] const core::Atlas& atlas() const { return atlas_; }
  /// Row by row, atlas().width texels each.
  [[nodiscard]] const std::vector<Texel>& texels() const { return texels_; }
  [[nodiscard]] std::vector<Texel>& texels() { return texels_; }

  /// Zeros as long as nobody has counted.
  [[nodiscard]] const TexelCount& texel_count() const { return texel_count_; }
  void set_texel_count(const TexelCount& count) { texel_count_ = count; }

  [[nodiscard]] std::size_t page_count() const;
  /// The page that holds a texel.
  [[nodiscard]] std::size_t page_of(std::size_t texel_idx) const {
    // An atlas has fewer texels than 2^32, and short divisions are quick ones.
    const auto texel = static_cast<std::uint32_t>(texel_idx);
    const auto width = static_cast<std::uint32_t>(atlas_.width);
    return texel / width / kPage * pages_per_row_ + texel % width / kPage;
  }
  /// Texels that a page covers.
  [[nodiscard]] cv::Rect page(std::size_t page_idx) const;

  /// Bilinear, sRGB in [0, 1]; `place` on the atlas, texels. Beyond the outermost centres the
  /// texture goes on as it ends.
  [[nodiscard]] Eigen::Vector3f read(const Eigen::Vector2f& place) const;

  /// The same at a place on a triangle of the mesh.
  [[nodiscard]] Eigen::Vector3f at(std::size_t triangle_idx,
                                   const Eigen::Vector3f& barycentric) const {
    return read(barycentric[0] * atlas_.place(triangle_idx, 0) +
                barycentric[1] * atlas_.place(triangle_idx, 1) +
                barycentric[2] * atlas_.place(triangle_idx, 2));
  }

 private:
  core::Atlas atlas_;
  std::vector<Texel> texels_;
  std::size_t pages_per_row_;
  TexelCount texel_count_;
};

}  // namespace sheen::fitting
