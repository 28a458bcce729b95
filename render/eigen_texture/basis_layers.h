// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/eigen_texture/eigen_texture.h"
#include "render/detail/texture_upload.h"
#include "render/gl/owners.h"

#include <Eigen/Core>

#include <cstddef>

namespace sheen::render::eigen_texture {

/// Mean and bases of an eigen-texture on the GPU, and what the bases are multiplied with: what
/// eigen_texture/layers.glsl reads. The context is current in all calls; `gl` and the light field
/// outlive it.
class BasisLayers {
 public:
  /// Sends all of the light field as it is now. Throws core::Error (run_failed) when the driver
  /// cannot hold it.
  BasisLayers(const gl::Functions& gl, const fitting::eigen_texture::EigenTexture& model);

  /// Takes the coefficients towards an eye (object frame, metres).
  void look_from(const Eigen::Vector3f& eye);

  /// Lets the next draw read mean and layers.
  void bind() const;
  /// Lets it read no layers: the caller binds a texture in the mean's place.
  void bind_no_layers() const;

  [[nodiscard]] std::size_t byte_size() const;

 private:
  void send_bases();

  const gl::Functions& gl_;
  const fitting::eigen_texture::EigenTexture& model_;
  detail::TextureUpload mean_;
  std::size_t layer_count_;
  gl::Texture bases_;
  gl::Buffer layers_;  ///< their number, then the layers; as the last eye sees them
  gl::Buffer no_layers_;
};

}  // namespace sheen::render::eigen_texture
