// SPDX-License-Identifier: MIT
#include "render/eigen_texture/eigen_texture_renderer.h"

#include "core/samples/vertex_view.h"
#include "fitting/detail/detail_light_field.h"
#include "render/eigen_texture/eigen_paint.h"
#include "render/eigen_texture/texture_blender.h"
#include "render/gl/functions.h"
#include "render/surface/surface_renderer.h"

#include <numeric>
#include <optional>
#include <vector>

namespace sheen::render {
namespace {

class EigenTextureRenderer final : public Renderer {
 public:
  EigenTextureRenderer(Context& context, const core::Mesh& mesh,
                       const fitting::eigen_texture::EigenTexture& light_field, int threads)
      : light_field_(light_field),
        textured_(mesh, light_field.mean().atlas()),
        surface_(make_gl_surface_renderer(context, mesh, textured_, threads)),
        pages_(textured_.texture().page_count()) {
    std::iota(pages_.begin(), pages_.end(), static_cast<std::uint32_t>(textured_.patch_count()));
    take_over();
  }

  std::size_t upload(std::span<const std::uint32_t> elements) override {
    if (!elements.empty()) take_over();
    return 0;
  }

  RenderedView render(const core::CameraModel& camera,
                      const Eigen::Isometry3d& camera_from_object) override {
    blend(core::eye_in_object(camera_from_object));
    return surface_->render(camera, camera_from_object);
  }

  void draw(gl::OffscreenTarget& target, const core::CameraModel& camera,
            const Eigen::Isometry3d& camera_from_object) override {
    blend(core::eye_in_object(camera_from_object));
    surface_->draw(target, camera, camera_from_object);
  }

 private:
  void take_over() {
    blender_.emplace(light_field_, eigen_texture::blend_kernels().front());
    textured_.texture().texels() = light_field_.mean().texels();
    std::vector<std::uint32_t> patches(textured_.patch_count());
    std::iota(patches.begin(), patches.end(), 0u);
    for (const std::uint32_t patch : patches) {
      textured_.offsets().store_observed(patch, light_field_.vertex_means().observed()[patch] != 0);
    }
    surface_->upload(patches);
  }

  void blend(const Eigen::Vector3f& eye) {
    blender_->blend(eye, textured_.texture().texels());
    surface_->upload(pages_);
  }

  const fitting::eigen_texture::EigenTexture& light_field_;
  fitting::detail::DetailLightField textured_;            ///< the texture as the last view sees it
  std::optional<eigen_texture::TextureBlender> blender_;  ///< of the light field as uploaded
  std::unique_ptr<Renderer> surface_;
  std::vector<std::uint32_t> pages_;  ///< all of the texture
};

}  // namespace

std::unique_ptr<Renderer> make_eigen_texture_renderer(
    Context& context, const core::Mesh& mesh,
    const fitting::eigen_texture::EigenTexture& light_field, int threads) {
  if (gl::is_software(gl::load_functions(context))) {
    return make_cpu_eigen_texture_renderer(context, mesh, light_field, threads);
  }
  return make_painted_renderer(context, mesh, [&](const gl::Functions& gl) {
    return eigen_texture::make_eigen_paint(gl, light_field);
  });
}

std::unique_ptr<Renderer> make_cpu_eigen_texture_renderer(
    Context& context, const core::Mesh& mesh,
    const fitting::eigen_texture::EigenTexture& light_field, int threads) {
  return std::make_unique<EigenTextureRenderer>(context, mesh, light_field, threads);
}

}  // namespace sheen::render
