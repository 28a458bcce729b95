// SPDX-License-Identifier: MIT
#include "core/samples/vertex_view.h"
#include "render/gl/offscreen_target.h"
#include "render/surface/invalid_ray_mask.h"
#include "render/surface/patch_shader.h"
#include "render/surface/surface_layer.h"
#include "render/surface/surface_renderer.h"
#include "render/views/read_view.h"

#include <opencv2/core.hpp>

#include <cassert>

namespace sheen::render {
namespace {

class GlSurfaceRenderer final : public Renderer {
 public:
  GlSurfaceRenderer(Context& context, const core::Mesh& mesh, const MakePaint& make_paint,
                    bool reads_light_field)
      : context_(context),
        gl_(gl::load_functions(context)),
        layer_(gl_, mesh, make_paint(gl_)),
        target_(gl_, gl::Colour::bytes),
        reads_light_field_(reads_light_field) {}

  ~GlSurfaceRenderer() override { context_.make_current(); }
  GlSurfaceRenderer(const GlSurfaceRenderer&) = delete;
  GlSurfaceRenderer& operator=(const GlSurfaceRenderer&) = delete;
  GlSurfaceRenderer(GlSurfaceRenderer&&) = delete;
  GlSurfaceRenderer& operator=(GlSurfaceRenderer&&) = delete;

  std::size_t upload(std::span<const std::uint32_t> patches) override {
    context_.make_current();
    return layer_.upload(patches);
  }

  void draw(gl::OffscreenTarget& target, const core::CameraModel& camera,
            const Eigen::Isometry3d& camera_from_object) override {
    layer_.draw(target, camera, camera_from_object);
  }

  [[nodiscard]] bool reads_light_field() const override { return reads_light_field_; }

  RenderedView render(const core::CameraModel& camera,
                      const Eigen::Isometry3d& camera_from_object) override {
    context_.make_current();
    layer_.draw(target_, camera, camera_from_object);
    RenderedView view = read_view(gl_, {camera.width_px(), camera.height_px()});
    if (const cv::Mat& invalid = invalid_rays_.of(camera); !invalid.empty()) {
      for (cv::Mat* const plane : {&view.image, &view.mask, &view.support}) {
        plane->setTo(0, invalid);
      }
    }
    return view;
  }

 private:
  Context& context_;
  gl::Functions gl_;
  SurfaceLayer layer_;
  gl::OffscreenTarget target_;
  bool reads_light_field_;
  InvalidRayMask invalid_rays_;
};

}  // namespace

std::unique_ptr<Renderer> make_gl_surface_renderer(Context& context, const core::Mesh& mesh,
                                                   const fitting::PatchLightField& light_field,
                                                   int threads) {
  assert(light_field.patch_count() == mesh.positions.size());
  const auto make_paint = [&](const gl::Functions& gl) {
    return make_patch_shader(gl, mesh, light_field, threads);
  };
  return std::make_unique<GlSurfaceRenderer>(context, mesh, make_paint,
                                             !has_patch_shader(light_field));
}

std::unique_ptr<Renderer> make_painted_renderer(Context& context, const core::Mesh& mesh,
                                                const MakePaint& make_paint) {
  return std::make_unique<GlSurfaceRenderer>(context, mesh, make_paint, true);
}

}  // namespace sheen::render
