// SPDX-License-Identifier: MIT
#include "render/renderer.h"

#include "core/diagnostics/error.h"
#include "fitting/descriptor.h"
#include "fitting/patch_light_field.h"
#include "render/billboard/billboard_renderer.h"
#include "render/depth_quads/quad_renderer.h"
#include "render/eigen_texture/eigen_texture_renderer.h"
#include "render/gl/offscreen_target.h"
#include "render/multi_eigenspace/eigenspace_renderer.h"
#include "render/surface/surface_renderer.h"
#include "render/view_dependent_texture/view_texture_renderer.h"

#include <opencv2/imgproc.hpp>

#include <string>

namespace sheen::render {
namespace {

/// What draws light fields that are not made of patches: a line for each. Gives null for others.
std::unique_ptr<Renderer> make_image_renderer(Context& context, const core::Mesh& mesh,
                                              const fitting::LightField& light_field, int threads) {
  if (const auto* quads = dynamic_cast<const fitting::depth_quads::DepthQuads*>(&light_field)) {
    return make_quad_renderer(context, *quads, threads);
  }
  if (const auto* texture =
          dynamic_cast<const fitting::view_dependent_texture::ViewTexture*>(&light_field)) {
    return make_view_texture_renderer(mesh, *texture, threads);
  }
  if (const auto* billboards = dynamic_cast<const fitting::billboard::Billboards*>(&light_field)) {
    return make_billboard_renderer(context, *billboards, threads);
  }
  if (const auto* spaces =
          dynamic_cast<const fitting::multi_eigenspace::MultiEigenspace*>(&light_field)) {
    return make_eigenspace_renderer(*spaces, threads);
  }
  return nullptr;
}

}  // namespace

void Renderer::draw(gl::OffscreenTarget& target, const core::CameraModel& camera,
                    const Eigen::Isometry3d& camera_from_object) {
  constexpr std::uint8_t unsupported = 128;
  const RenderedView view = render(camera, camera_from_object);
  cv::Mat alpha(view.mask.size(), CV_8UC1, cv::Scalar(0));
  alpha.setTo(unsupported, view.mask);
  alpha.setTo(255, view.support);
  const std::array<cv::Mat, 2> planes{view.image, alpha};
  cv::Mat rgba(view.image.size(), CV_8UC4);
  cv::mixChannels(planes.data(), planes.size(), &rgba, 1,
                  std::array<int, 8>{2, 0, 1, 1, 0, 2, 3, 3}.data(), 4);
  target.replace(rgba);
}

std::unique_ptr<Renderer> make_renderer(Context& context, const core::Mesh& mesh,
                                        const fitting::LightField& light_field, int threads) {
  const auto& descriptor = fitting::representation_named(light_field.representation());
  if (descriptor.make_renderer != nullptr) {
    return descriptor.make_renderer(context, mesh, light_field, threads);
  }
  if (const auto* const patches = fitting::as_patches(light_field)) {
    return make_gl_surface_renderer(context, mesh, *patches, threads);
  }
  if (const auto* const texture =
          dynamic_cast<const fitting::eigen_texture::EigenTexture*>(&light_field)) {
    return make_eigen_texture_renderer(context, mesh, *texture, threads);
  }
  if (auto renderer = make_image_renderer(context, mesh, light_field, threads)) return renderer;
  throw core::Error(core::Error::Kind::run_failed,
                    "representation " + std::string(light_field.representation()),
                    "has no renderer in this program", "use the version of sheen that made it");
}

}  // namespace sheen::render
