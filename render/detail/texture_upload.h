// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/texture/surface_texture.h"
#include "render/gl/owners.h"

#include <cstddef>

namespace sheen::render::detail {

/// A surface's texture on the GPU, read bilinearly. The context is current in all calls.
class TextureUpload {
 public:
  /// Sends all of it. `gl` and `texture` outlive this. Throws core::Error (run_failed) for one that
  /// is too large for the driver.
  TextureUpload(const gl::Functions& gl, const fitting::SurfaceTexture& texture);

  /// Sends a page anew; returns its bytes.
  std::size_t send(std::size_t page_idx) const;

  void bind(GLuint unit) const { gl_.BindTextureUnit(unit, name_.name()); }

 private:
  std::size_t send(const cv::Rect& part) const;

  const gl::Functions& gl_;
  const fitting::SurfaceTexture& texture_;
  gl::Texture name_;
};

}  // namespace sheen::render::detail
