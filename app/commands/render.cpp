// SPDX-License-Identifier: MIT
#include "app/commands/render.h"

#include "app/commands/frame_options.h"
#include "app/terminal_sink.h"
#include "core/image/write_image.h"
#include "fitting/model_file/model_file.h"
#include "pipeline/pose_frames.h"
#include "pipeline/posed_views.h"
#include "pipeline/session_mesh.h"
#include "render/renderer.h"

#include <fmt/format.h>

namespace sheen::app {
namespace {

struct RenderOptions {
  std::filesystem::path model;
  std::filesystem::path session;
  pipeline::FrameChoice frames;
  std::filesystem::path folder;
};

void run_render(const RenderOptions& options, const CommandContext& context) {
  context.check_outputs({});
  const fitting::Model model = fitting::read_model(options.model);
  capture::Session session = capture::open_session(options.session);
  session.take_offset(model.mesh.offset);
  TerminalSink sink(context);
  const auto views = pipeline::pose_frames(session, options.frames, sink);
  pipeline::SessionScene::check(session, model.mesh, options.frames.pose_source, views, sink);
  const auto gl = render::make_osmesa_context();
  const auto renderer = render::make_renderer(*gl, model.mesh, *model.light_field, context.threads);
  int done = 0;
  pipeline::for_each_view(
      session, views,
      [&](const capture::Frame& frame, const Eigen::Isometry3d& camera_from_object) {
        const auto view = renderer->render(session.camera_of(frame.index), camera_from_object);
        core::write_image(options.folder / fmt::format("{:04d}.png", frame.index), view.image);
        sink.progress({"rendering", ++done, static_cast<int>(views.size())});
      });
  context.publish({{"views", done}, {"folder", options.folder.string()}},
                  fmt::format("written  {} views to {}\n", done, options.folder.string()));
}

}  // namespace

void add_render_command(CommandLine& program, CommandContext& context) {
  auto options = std::make_shared<RenderOptions>();
  Command command = program.command(
      "render", "Draw a model from every posed view of a session, lens distortion included");
  command.example(
      "Example:\n  sheen render model.glb --views sample_data/glossy/held_out -o views");
  command.option("model", options->model, "Model file (.glb)").required();
  command.option("--views", options->session, "Session whose views are drawn")
      .required()
      .type("SESSION");
  command.option("-o,--output", options->folder, "Folder for NNNN.png, by frame index")
      .required()
      .type("DIR");
  add_frame_options(command, options->frames);
  add_common_options(command, context);
  command.action([options, &context] { run_render(*options, context); });
}

}  // namespace sheen::app
