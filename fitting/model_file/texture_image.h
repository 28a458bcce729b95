// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/texture/surface_texture.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sheen::fitting {

/// The texels of a texture as a PNG file, and back without loss; `corners` are those of its atlas.
/// Throws ModelFault for other bytes, and for images that are larger than an atlas may be.
std::vector<std::uint8_t> encode_texture(const SurfaceTexture& texture);
SurfaceTexture decode_texture(std::span<const std::byte> bytes,
                              std::vector<std::array<core::AtlasPoint, 3>> corners);

}  // namespace sheen::fitting
