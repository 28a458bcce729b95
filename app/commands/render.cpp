// SPDX-License-Identifier: MIT
#include "app/commands/render.h"

#include "app/commands/frame_options.h"
#include "app/commands/turntable.h"
#include "app/terminal_sink.h"
#include "core/image/write_image.h"
#include "fitting/model_file/model_file.h"
#include "pipeline/pose_frames.h"
#include "pipeline/session_mesh.h"
#include "pipeline/session_readout.h"
#include "render/renderer.h"

#include <fmt/format.h>

namespace sheen::app {
namespace {

struct RenderOptions {
  std::filesystem::path model;
  std::filesystem::path session;
  pipeline::FrameChoice frames;
  TurntableOptions turntable;
  std::filesystem::path output;  ///< folder, of a turntable also a video
};

void render_views(const RenderOptions& options, const CommandContext& context) {
  context.check_outputs({});
  const fitting::Model model = fitting::read_model(options.model);
  capture::Session session = capture::open_session(options.session);
  session.take_offset(model.mesh.offset);
  TerminalSink sink(context);
  pipeline::complete_readout(session, options.frames, sink);
  const auto views = pipeline::pose_frames(session, options.frames, sink);
  pipeline::SessionScene::check(session, model.mesh, options.frames.pose_source, views, sink);
  const auto gl = render::make_osmesa_context();
  const auto renderer = render::make_renderer(*gl, model.mesh, *model.light_field, context.threads);
  int done = 0;
  for (const pipeline::PosedFrame& view : views) {
    const auto drawn = renderer->render(session.camera_of(view.index),
                                        view.camera_from_board * session.board_from_object);
    core::write_image(options.output / fmt::format("{:04d}.png", view.index), drawn.image);
    sink.progress({"rendering", ++done, static_cast<int>(views.size())});
  }
  context.publish({{"views", done}, {"folder", options.output.string()}},
                  fmt::format("written  {} views to {}\n", done, options.output.string()));
}

void run_render(const RenderOptions& options, const CommandContext& context) {
  if (options.turntable.pictures > 0) {
    render_turntable(options.model, options.output, options.turntable, context);
  } else {
    render_views(options, context);
  }
}

void add_turntable_options(Command command, Command what, TurntableOptions& options) {
  what.option("--turntable", options.pictures, "Pictures of one turn round the object")
      .positive()
      .type("N");
  command
      .option(
          "--size", [&options](const std::string& text) { options.size_px = picture_size(text); },
          "Of a turntable's pictures, pixels [800x800]")
      .type("WxH");
  command
      .option(
          "--background",
          [&options](const std::string& text) { options.background = background_colour(text); },
          "Of a turntable [none: transparent, in a video dark]")
      .type("none|dark|light|#rrggbb");
  command.option("--up", options.up, "Axis of the object that points upwards")
      .one_of({"x", "y", "z", "-x", "-y", "-z"})
      .show_default();
  constexpr int most_copies = 1'000'000;
  command
      .option("--copies", options.copies,
              "Of the object in every picture of a turntable, drawn at once (multi-eigenspace, "
              "billboard)")
      .range(1, most_copies)
      .type("N");
  command.option("--fps", options.fps, "Pictures a second of a turntable's video")
      .range(1, 240)
      .show_default();
}

}  // namespace

void add_render_command(CommandLine& program, CommandContext& context) {
  auto options = std::make_shared<RenderOptions>();
  Command command = program.command("render",
                                    "Draw a model from every posed view of a session, lens "
                                    "distortion included, or from all round");
  command.example(
      "Examples:\n"
      "  sheen render model.glb --views sample_data/glossy/held_out -o views\n"
      "  sheen render model.glb --turntable 120 --size 1280x720 -o model.mp4");
  command.option("model", options->model, "Model file (.glb)").required();
  Command what = command.exactly_one_of("What is drawn", "");
  what.option("--views", options->session, "Views of this session").type("SESSION");
  command
      .option("-o,--output", options->output,
              "Folder for NNNN.png, by frame index; of a turntable also a video, FILE.mp4")
      .required()
      .type("DIR");
  add_turntable_options(command, what, options->turntable);
  add_frame_options(command, options->frames);
  add_common_options(command, context);
  command.action([options, &context] { run_render(*options, context); });
}

}  // namespace sheen::app
