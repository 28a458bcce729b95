// SPDX-License-Identifier: MIT
#include "render/surface/object_mask.h"

#include "fitting/mean/mean_light_field.h"
#include "render/surface/surface_renderer.h"

namespace sheen::render {

/// A light field of one grey, of which only the mask is looked at.
struct ObjectMask::Impl {
  Impl(Context& context, const core::Mesh& mesh)
      : grey(mesh.positions.size()), renderer(make_gl_surface_renderer(context, mesh, grey)) {}

  fitting::mean::MeanLightField grey;
  std::unique_ptr<Renderer> renderer;
};

ObjectMask::ObjectMask(Context& context, const core::Mesh& mesh)
    : impl_(std::make_unique<Impl>(context, mesh)) {}

ObjectMask::~ObjectMask() = default;

cv::Mat ObjectMask::seen_by(const core::CameraModel& camera,
                            const Eigen::Isometry3d& camera_from_object) {
  return impl_->renderer->render(camera, camera_from_object).mask;
}

}  // namespace sheen::render
