// SPDX-License-Identifier: MIT
#pragma once

#include "render/gl/owners.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sheen::render {

/// The same number of RGBA16F texels for every patch, in a buffer texture: patch i owns texels
/// [i * texels_per_patch, (i + 1) * texels_per_patch).
class PatchBuffer {
 public:
  /// Both counts >= 1. Throws core::Error (run_failed) beyond the driver's
  /// GL_MAX_TEXTURE_BUFFER_SIZE.
  PatchBuffer(const gl::Functions& gl, std::size_t patch_count, std::size_t texels_per_patch);

  /// Calls `write(patch_idx, span of 4 * texels_per_patch halfs)` for each of `patches` (ascending,
  /// no repeats) and sends runs of neighbouring patches in one piece each. Returns the bytes sent.
  template <typename Write>
  std::size_t upload(std::span<const std::uint32_t> patches, const Write& write) {
    std::size_t begin = 0;
    while (begin < patches.size()) {
      std::size_t end = begin + 1;
      while (end < patches.size() && patches[end] == patches[end - 1] + 1) ++end;
      staging_.resize((end - begin) * halfs_per_patch_);
      for (std::size_t i = begin; i < end; ++i) {
        write(patches[i],
              std::span(staging_).subspan((i - begin) * halfs_per_patch_, halfs_per_patch_));
      }
      send(patches[begin]);
      begin = end;
    }
    return patches.size() * halfs_per_patch_ * sizeof(Eigen::half);
  }

  /// Binds the buffer texture to a texture unit.
  void bind(GLuint unit) const;

 private:
  /// Sends the staged patches to where `first_patch` begins.
  void send(std::size_t first_patch) const;

  const gl::Functions& gl_;
  std::size_t halfs_per_patch_;
  std::vector<Eigen::half> staging_;
  gl::Buffer buffer_;
  gl::Texture texture_;
};

/// Texels of a patch whose model is a list of colours: r, g, b each, and in alpha of the first the
/// weight with which the patch enters the interpolation. `colours` holds [texel][r, g, b].
void write_colours(std::span<const Eigen::half> colours, bool observed,
                   std::span<Eigen::half> texels);

/// 0, 1, ... patch_count - 1: the update that uploads everything.
std::vector<std::uint32_t> all_patches(std::size_t patch_count);

}  // namespace sheen::render
