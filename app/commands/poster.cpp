// SPDX-License-Identifier: MIT
#include "app/commands/poster.h"

#include "app/commands/smooth_picture.h"
#include "core/image/write_image.h"
#include "exporters/upright.h"
#include "exporters/viewer/first_view.h"

namespace sheen::app {
namespace {

constexpr int kPosterSide_px = 720;

}  // namespace

void draw_missing_poster(const fitting::Model& model, const exporters::viewer::Options& page,
                         const CommandContext& context) {
  if (page.poster.empty() || std::filesystem::exists(page.poster)) return;
  context.check_outputs({page.poster});
  const auto gl = render::make_osmesa_context();
  const auto renderer = render::make_renderer(*gl, model.mesh, *model.light_field, context.threads);
  const Eigen::Vector3f up = exporters::y_up_from_object(page.up).row(1);
  OrbitCamera camera(model.mesh, up.cast<double>());
  const auto view = exporters::viewer::first_view(model.mesh, model.seen, page.up);
  camera.stand_at(camera.object_centre() + view.towards_eye);
  camera.frame();
  core::write_image(page.poster,
                    smooth_picture(*renderer, camera, {kPosterSide_px, kPosterSide_px}));
}

}  // namespace sheen::app
