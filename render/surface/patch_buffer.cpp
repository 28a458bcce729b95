// SPDX-License-Identifier: MIT
#include "render/surface/patch_buffer.h"

#include "core/diagnostics/error.h"
#include "fitting/patch_light_field.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <string>

namespace sheen::render {

namespace {

core::Error too_large(std::size_t patch_count, const std::string& fault) {
  return {core::Error::Kind::run_failed, "model of " + std::to_string(patch_count) + " patches",
          fault, "use a coarser mesh, fewer centres or fewer terms"};
}

}  // namespace

PatchBuffer::PatchBuffer(const gl::Functions& gl, std::size_t patch_count,
                         std::size_t texels_per_patch)
    : gl_(gl), halfs_per_patch_(4 * texels_per_patch) {
  assert(patch_count > 0 && texels_per_patch > 0);
  const auto limit = static_cast<std::size_t>(gl::integer_limit(gl, GL_MAX_TEXTURE_BUFFER_SIZE));
  const std::size_t texels = patch_count * texels_per_patch;
  if (texels > limit) {
    throw too_large(patch_count, "needs " + std::to_string(texels) +
                                     " texels, this OpenGL driver holds " + std::to_string(limit));
  }
  const std::size_t bytes = patch_count * halfs_per_patch_ * sizeof(Eigen::half);
  buffer_ = gl::make_buffer(gl_, static_cast<GLsizeiptr>(bytes), nullptr);
  if (gl_.GetError() == GL_OUT_OF_MEMORY) {
    throw too_large(patch_count, "needs " + std::to_string(bytes) +
                                     " bytes, more memory than this OpenGL driver has");
  }
  texture_ = gl::make_texture(gl_, GL_TEXTURE_BUFFER);
  gl_.TextureBuffer(texture_.name(), GL_RGBA16F, buffer_.name());
}

void PatchBuffer::bind(GLuint unit) const {
  gl_.BindTextureUnit(unit, texture_.name());
}

void PatchBuffer::send(std::size_t first_patch) const {
  gl_.NamedBufferSubData(
      buffer_.name(), static_cast<GLintptr>(first_patch * halfs_per_patch_ * sizeof(Eigen::half)),
      static_cast<GLsizeiptr>(staging_.size() * sizeof(Eigen::half)), staging_.data());
}

void write_colours(std::span<const Eigen::half> colours, bool observed,
                   std::span<Eigen::half> texels) {
  assert(3 * texels.size() == 4 * colours.size());
  for (std::size_t texel = 0; 3 * texel < colours.size(); ++texel) {
    std::ranges::copy(colours.subspan(3 * texel, 3), texels.subspan(4 * texel).begin());
    texels[4 * texel + 3] = Eigen::half(0.0f);
  }
  texels[3] = Eigen::half(observed ? 1.0f : fitting::kUnseenWeight);
}

std::vector<std::uint32_t> all_patches(std::size_t patch_count) {
  std::vector<std::uint32_t> patches(patch_count);
  std::iota(patches.begin(), patches.end(), 0u);
  return patches;
}

}  // namespace sheen::render
