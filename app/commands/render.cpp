// SPDX-License-Identifier: MIT
#include "app/commands/render.h"

#include "app/commands/session_options.h"
#include "app/evaluation/posed_views.h"
#include "core/image/write_image.h"
#include "fitting/model_file/model_file.h"
#include "render/surface/surface_renderer.h"

#include <fmt/format.h>

namespace sheen::app {
namespace {

struct RenderOptions {
  std::filesystem::path model;
  SessionOptions session;
  std::filesystem::path folder;
};

void run_render(const RenderOptions& options, const CommandContext& context) {
  context.check_outputs({});
  const fitting::Model model = fitting::read_model(options.model);
  const capture::Session session = capture::open_session(options.session.folder);
  std::vector<PosedFrame> views;
  {
    Progress progress = context.progress("posing", 0);
    views = pose_frames(session, options.session, [&](int read) { progress.show(read); });
  }
  const auto gl = render::make_osmesa_context();
  const auto renderer = render::make_gl_surface_renderer(*gl, model.mesh, *model.light_field);
  Progress progress = context.progress("rendering", static_cast<int>(views.size()));
  int done = 0;
  for_each_view(session, views,
                [&](const capture::Frame& frame, const Eigen::Isometry3d& camera_from_object) {
                  const auto view = renderer->render(session.camera, camera_from_object);
                  core::write_image(options.folder / fmt::format("{:04d}.png", frame.index),
                                    view.image);
                  progress.show(++done);
                });
  context.publish({{"views", done}, {"folder", options.folder.string()}},
                  fmt::format("written  {} views to {}\n", done, options.folder.string()));
}

}  // namespace

void add_render_command(CLI::App& program, CommandContext& context) {
  auto options = std::make_shared<RenderOptions>();
  CLI::App* command = program.add_subcommand(
      "render", "Draw a model from every posed view of a session, lens distortion included");
  command->footer(
      "Example:\n  sheen render model.glb --views sample_data/glossy/held_out -o views");
  command->add_option("model", options->model, "Model file (.glb)")->required();
  command->add_option("--views", options->session.folder, "Session whose views are drawn")
      ->required()
      ->type_name("SESSION");
  command->add_option("-o,--output", options->folder, "Folder for NNNN.png, by frame index")
      ->required()
      ->type_name("DIR");
  add_session_options(*command, options->session);
  add_common_options(*command, context);
  command->callback([options, &context] { run_render(*options, context); });
}

}  // namespace sheen::app
