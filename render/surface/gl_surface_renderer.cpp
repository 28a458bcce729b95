// SPDX-License-Identifier: MIT
#include "core/samples/vertex_view.h"
#include "render/gl/offscreen_target.h"
#include "render/surface/invalid_ray_mask.h"
#include "render/surface/patch_shader.h"
#include "render/surface/surface_layer.h"
#include "render/surface/surface_renderer.h"

#include <opencv2/core.hpp>

#include <array>
#include <cassert>

namespace sheen::render {
namespace {

/// Alpha as shaders/surface.frag writes it: 0 background, 128 seen, 255 seen and supported.
constexpr std::uint8_t kSupported = 255;

class GlSurfaceRenderer final : public Renderer {
 public:
  GlSurfaceRenderer(Context& context, const core::Mesh& mesh, const MakePaint& make_paint,
                    bool reads_light_field)
      : context_(context),
        gl_(gl::load_functions(context)),
        layer_(gl_, mesh, make_paint(gl_)),
        target_(gl_, true),
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
    // Draw.
    context_.make_current();
    layer_.draw(target_, camera, camera_from_object);

    // Read back; four bytes per pixel, so rows need no padding.
    pixels_.create(camera.height_px(), camera.width_px(), CV_8UC4);
    gl_.ReadPixels(0, 0, pixels_.cols, pixels_.rows, GL_BGRA, GL_UNSIGNED_BYTE, pixels_.data);
    if (const cv::Mat& invalid = invalid_rays_.of(camera); !invalid.empty())
      pixels_.setTo(0, invalid);
    return split();
  }

 private:
  [[nodiscard]] RenderedView split() const {
    RenderedView view;
    view.image.create(pixels_.size(), CV_8UC3);
    cv::Mat alpha(pixels_.size(), CV_8UC1);
    std::array<cv::Mat, 2> planes{view.image, alpha};
    constexpr std::array<int, 8> from_to{0, 0, 1, 1, 2, 2, 3, 3};
    cv::mixChannels(&pixels_, 1, planes.data(), planes.size(), from_to.data(), 4);
    cv::compare(alpha, 0, view.mask, cv::CMP_GT);
    cv::compare(alpha, kSupported, view.support, cv::CMP_EQ);
    return view;
  }

  Context& context_;
  gl::Functions gl_;
  SurfaceLayer layer_;
  gl::OffscreenTarget target_;
  bool reads_light_field_;
  InvalidRayMask invalid_rays_;
  cv::Mat pixels_;
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
