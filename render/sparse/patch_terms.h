// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/sparse/light_field_model.h"
#include "render/gl/owners.h"
#include "render/surface/patch_buffer.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace sheen::render::sparse {

/// Sparse patches on the GPU as sparse.glsl reads them, one texel per term. All patches get as many
/// texels as the largest one needs: one fetch finds a patch, and a changed patch is sent to its own
/// place.
class PatchTerms {
 public:
  /// Sends all. `gl` and `model` outlive it.
  PatchTerms(const gl::Functions& gl, const fitting::sparse::LightFieldModel& model);

  /// As PatchShader::upload.
  std::size_t upload(std::span<const std::uint32_t> patches) {
    return send(make_room(patches) ? std::span<const std::uint32_t>(all_) : patches);
  }
  [[nodiscard]] std::size_t texels_per_patch() const { return texels_per_patch_; }
  void bind(GLuint unit) const { buffer_->bind(unit); }

 private:
  bool make_room(std::span<const std::uint32_t> patches);
  std::size_t send(std::span<const std::uint32_t> patches);

  const gl::Functions& gl_;
  const fitting::sparse::LightFieldModel& model_;
  std::vector<std::uint32_t> all_;
  std::size_t texels_per_patch_ = 0;
  std::unique_ptr<PatchBuffer> buffer_;
};

}  // namespace sheen::render::sparse
