// SPDX-License-Identifier: MIT
#include "render/eigen_texture/texture_blender.h"

#include <algorithm>

namespace sheen::render::eigen_texture {
namespace {

/// Where a number lies.
std::size_t place_of(BasisLayout layout, std::size_t bases, std::size_t texels, std::size_t k,
                     std::size_t i) {
  switch (layout) {
    case BasisLayout::planes:
      return k * texels + i;
    case BasisLayout::pairs:
      return k / 2 * 2 * texels + 2 * i + k % 2;
    case BasisLayout::tiles:
      return i / kTile * kTile * bases + k / 2 * 2 * kTile + 2 * (i % kTile) + k % 2;
  }
  return 0;
}

}  // namespace

BlendedChannel::BlendedChannel(const fitting::eigen_texture::Channel& channel, std::size_t texels,
                               const BlendKernel& kernel)
    : kernel_(kernel.blend),
      bases_(kernel.layout == BasisLayout::planes ? channel.bases : (channel.bases + 1) / 2 * 2),
      coefficients_(bases_, 0),
      sums_((texels + kTile - 1) / kTile * kTile, 0) {
  basis_.assign(bases_ * sums_.size(), 0);
  for (std::size_t k = 0; k < channel.bases; ++k) {
    const std::int8_t* const row = channel.texels.data() + k * texels;
    for (std::size_t i = 0; i < texels; ++i) {
      basis_[place_of(kernel.layout, bases_, sums_.size(), k, i)] = row[i];
    }
  }
}

const std::vector<std::int16_t>& BlendedChannel::blend(const std::vector<float>& coefficients) {
  for (std::size_t k = 0; k < coefficients.size(); ++k) {
    coefficients_[k] = fixed_coefficient(coefficients[k]);
  }
  if (bases_ > 0) {
    kernel_(basis_.data(), bases_, sums_.size(), coefficients_.data(), sums_.data());
  }
  return sums_;
}

TextureBlender::TextureBlender(const fitting::eigen_texture::EigenTexture& light_field,
                               const BlendKernel& kernel)
    : light_field_(light_field) {
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    channels_[c] = BlendedChannel(light_field.channels()[c], light_field.used().size(), kernel);
  }
}

// R = Y + 1.140 V, G = Y - .395 U - .581 V, B = Y + 2.033 U, added to the mean.
void TextureBlender::blend(const Eigen::Vector3f& eye, std::vector<fitting::Texel>& texels) {
  const auto sums = [&](std::size_t c) {
    return channels_[c].blend(light_field_.coefficients(c, eye)).data();
  };
  const std::int16_t* const luma = sums(0);
  const std::int16_t* const blue = sums(1);
  const std::int16_t* const red = sums(2);
  constexpr int bits = 8;  // of the factors below
  constexpr int shift = bits + kSumBits;
  const auto shown = [](int mean, int offset) {
    const int grey = ((mean << shift) + offset + (1 << (shift - 1))) >> shift;
    return static_cast<std::uint8_t>(std::clamp(grey, 0, 255));
  };
  const std::vector<fitting::Texel>& mean = light_field_.mean().texels();
  const std::vector<std::uint32_t>& used = light_field_.used();
  for (std::size_t i = 0; i < used.size(); ++i) {
    const fitting::Texel& from = mean[used[i]];
    const int y = luma[i] << bits;
    texels[used[i]] = {shown(from[0], y + 292 * red[i]),
                       shown(from[1], y - 101 * blue[i] - 149 * red[i]),
                       shown(from[2], y + 520 * blue[i])};
  }
}

}  // namespace sheen::render::eigen_texture
