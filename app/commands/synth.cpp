// SPDX-License-Identifier: MIT
#include "app/commands/synth.h"

#include "app/interrupt.h"
#include "capture/synthetic/synthetic_session.h"
#include "core/diagnostics/error.h"

#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace sheen::app {
namespace {

namespace synthetic = capture::synthetic;

constexpr const char* kWalk = "walk";
constexpr const char* kTurntable = "turntable";

struct SynthOptions {
  std::string scene;
  std::filesystem::path folder;
  std::string size;
  std::string mesh;
  std::string path = kWalk;
  synthetic::SyntheticOptions session;
};

std::string size_text(const synthetic::SyntheticOptions& session) {
  return fmt::format("{}x{}", session.width_px, session.height_px);
}

/// "640x360" -> width and height; empty when it is fine, else what is wrong (CLI11's convention).
std::string parse_size(const std::string& text, synthetic::SyntheticOptions& session) {
  int used = 0;
  int width = 0;
  int height = 0;
  const bool complete = std::sscanf(text.c_str(), "%5dx%5d%n", &width, &height, &used) == 2 &&
                        static_cast<std::size_t>(used) == text.size();
  if (!complete) return "must be WxH in pixels, for instance 640x360";
  session.width_px = width;
  session.height_px = height;
  return {};
}

void run_synth(SynthOptions& options, const CommandContext& context) {
  synthetic::SyntheticOptions& session = options.session;
  session.scene = synthetic::scene_kind(options.scene).value();
  if (!options.mesh.empty()) session.mesh = options.mesh;
  session.path =
      options.path == kTurntable ? synthetic::PathKind::turntable : synthetic::PathKind::walk;
  session.threads = context.threads;
  try {
    session.check();
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }

  context.check_outputs({});
  Progress progress = context.progress("rendering", session.frames + session.held_out);
  synthetic::write_synthetic_session(options.folder, session, [&](int done, int) {
    throw_if_interrupted();
    progress.show(done);
  });
  context.publish(
      {{"session", options.folder.string()},
       {"scene", options.scene},
       {"path", options.path},
       {"width", session.width_px},
       {"height", session.height_px},
       {"frames", session.frames},
       {"held_out", session.held_out},
       {"seed", session.seed}},
      fmt::format("written  {} frames of {} and {} held-out views to {}\n", session.frames,
                  size_text(session), session.held_out, options.folder.string()));
}

void add_image_options(Command command, SynthOptions& options) {
  synthetic::SyntheticOptions& session = options.session;
  options.size = size_text(session);
  command.option("--size", options.size, "Image size in pixels")
      .check([&session](const std::string& text) { return parse_size(text, session); })
      .type("WxH")
      .show_default();
  command.option("--frames", session.frames, "Frames of the recording")
      .range(2, 100'000)
      .type("N")
      .show_default();
  command
      .option("--held-out", session.held_out,
              "Noise-free views apart from the recording, in held_out/; 0: none")
      .range(0, 10'000)
      .type("N")
      .show_default();
  command
      .option("--samples", session.samples,
              "Rays per pixel of a frame; held-out views take four times as many")
      .range(1, 256)
      .type("N")
      .show_default();
  command.option("--quality", session.jpeg_quality, "JPEG quality of the video, 1 to 100")
      .range(1, 100)
      .type("Q")
      .show_default();
}

}  // namespace

void add_synth_command(CommandLine& program, CommandContext& context) {
  auto options = std::make_shared<SynthOptions>();
  synthetic::SyntheticOptions& session = options->session;
  Command command = program.command(
      "synth", "Make a synthetic session: a known object, light and camera on a board of tags");
  command.example("Example:\n  sheen synth glossy -o session --frames 120");
  const std::vector<std::string> names(synthetic::kSceneNames.begin(),
                                       synthetic::kSceneNames.end());
  command.option("scene", options->scene, "How the object's enamel shines")
      .required()
      .one_of(names);
  command.option("-o,--output", options->folder, "Session folder to write")
      .required()
      .type("SESSION");
  command.option("--vertices", session.vertices, "Vertices of the object, about")
      .range(500, 2'000'000)
      .type("N")
      .show_default();
  Option mesh_vertices =
      command
          .option("--mesh-vertices", session.mesh_vertices,
                  "Vertices of the session's mesh of the object, about; 0: as photographed")
          .range(0, 2'000'000)
          .type("N")
          .show_default();
  command
      .option("--mesh", options->mesh,
              "Put this mesh on the board instead (metres, z up; PLY, OBJ or GLB)")
      .excludes(mesh_vertices)
      .type("FILE");
  command
      .option("--path", options->path,
              "A camera in hand on a walk round the object, or the object on a turntable")
      .one_of({kWalk, kTurntable})
      .show_default();
  add_image_options(command, *options);
  command
      .option("--readout-ms", session.readout_ms,
              "A rolling shutter: milliseconds from the first row of a frame to the last; 0: all "
              "rows at once")
      .range(0, 33)
      .type("MS")
      .show_default();
  command.flag("--depth", session.depth,
               "Depth images beside the frames, too: depth/%04d.png, without noise");
  command.option("--seed", session.seed, "Seed of path, tremor and noise").type("N").show_default();
  add_common_options(command, context);
  command.action([options, &context] { run_synth(*options, context); });
}

}  // namespace sheen::app
