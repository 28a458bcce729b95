// SPDX-License-Identifier: MIT
#pragma once

#include "render/gl/offscreen_target.h"
#include "render/surface/patch_shader.h"
#include "render/surface/surface_pass.h"

#include <memory>

namespace sheen::render {

/// A mesh painted by one patch shader into textures that a window shows, without reading pixels
/// back. Alpha is 0 beside the object, one half where no patch seen in the fit contributes. The
/// context is current in all calls; `gl` outlives the layer.
class SurfaceLayer {
 public:
  SurfaceLayer(const gl::Functions& gl, const core::Mesh& mesh, std::unique_ptr<PatchShader> paint);

  /// Sends the paint of these patches (ascending, no repeats). Returns the bytes sent.
  std::size_t upload(std::span<const std::uint32_t> patches) { return paint_->upload(patches); }

  /// Draws into `target`, made as large as the camera's image; row 0 is the image's first row.
  void draw(gl::OffscreenTarget& target, const core::CameraModel& camera,
            const Eigen::Isometry3d& camera_from_object);

 private:
  std::unique_ptr<PatchShader> paint_;
  SurfacePass pass_;
};

}  // namespace sheen::render
