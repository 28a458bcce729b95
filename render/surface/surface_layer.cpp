// SPDX-License-Identifier: MIT
#include "render/surface/surface_layer.h"

#include "core/samples/vertex_view.h"

#include <utility>

namespace sheen::render {

SurfaceLayer::SurfaceLayer(const gl::Functions& gl, const core::Mesh& mesh,
                           std::unique_ptr<PatchShader> paint)
    : paint_(std::move(paint)), pass_(gl, mesh, *paint_) {}

void SurfaceLayer::draw(gl::OffscreenTarget& target, const core::CameraModel& camera,
                        const Eigen::Isometry3d& camera_from_object) {
  const GLuint framebuffer = target.framebuffer(camera.width_px(), camera.height_px());
  paint_->look_from(core::eye_in_object(camera_from_object),
                    {camera.width_px(), camera.height_px()});
  paint_->bind();
  pass_.set_adds_between(paint_->adds_between_patches());
  pass_.draw(framebuffer, camera, camera_from_object);
}

}  // namespace sheen::render
