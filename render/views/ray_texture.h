// SPDX-License-Identifier: MIT
#pragma once

#include "render/gl/owners.h"
#include "render/views/pixel_rays.h"

namespace sheen::render {

/// The ray of every pixel of a camera, lens included, for shaders: what shaders/pixel_ray.glsl
/// reads, exactly what the CPU draws with. Remembers the last camera. The context is current in all
/// calls; `gl` outlives it.
class RayTexture {
 public:
  RayTexture(const gl::Functions& gl, int threads) : gl_(gl), rays_(threads) {}

  /// Throws core::Error (run_failed) for images that are too large for the driver.
  void set_camera(const core::CameraModel& camera);
  void bind() const;

 private:
  const gl::Functions& gl_;
  PixelRays rays_;
  core::CameraModel camera_;
  gl::Texture texture_;
};

}  // namespace sheen::render
