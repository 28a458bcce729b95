// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/eigen_texture/eigen_texture.h"
#include "render/eigen_texture/blend_kernels.h"

#include <array>
#include <cstdint>
#include <vector>

namespace sheen::render::eigen_texture {

/// A channel's bases laid out for a kernel, and their weighted sum.
class BlendedChannel {
 public:
  BlendedChannel() = default;
  BlendedChannel(const fitting::eigen_texture::Channel& channel, std::size_t texels,
                 const BlendKernel& kernel);

  /// Sum over the bases, kSumBits fraction bits, one per texel and some more; `coefficients` has
  /// one per basis.
  const std::vector<std::int16_t>& blend(const std::vector<float>& coefficients);

 private:
  BlendFunction kernel_ = nullptr;
  std::size_t bases_ = 0;  ///< even where they lie in pairs: the last one may be zeros
  std::vector<std::int8_t> basis_;
  std::vector<std::int16_t> coefficients_, sums_;
};

/// The texture of an eigen-texture as an eye sees it, on the CPU.
class TextureBlender {
 public:
  /// Light field outlives it; changes of it are not seen.
  TextureBlender(const fitting::eigen_texture::EigenTexture& light_field,
                 const BlendKernel& kernel);

  /// Writes the used texels seen from `eye` (object frame, metres).
  void blend(const Eigen::Vector3f& eye, std::vector<fitting::Texel>& texels);

 private:
  const fitting::eigen_texture::EigenTexture& light_field_;
  std::array<BlendedChannel, 3> channels_;
};

}  // namespace sheen::render::eigen_texture
