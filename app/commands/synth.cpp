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

struct SynthOptions {
  std::string scene;
  std::filesystem::path folder;
  std::string size;
  std::string mesh;
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
  session.threads = context.threads;
  try {
    session.check();
  } catch (const std::invalid_argument& error) {
    throw CLI::ValidationError(error.what());
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
       {"width", session.width_px},
       {"height", session.height_px},
       {"frames", session.frames},
       {"held_out", session.held_out},
       {"seed", session.seed}},
      fmt::format("written  {} frames of {} and {} held-out views to {}\n", session.frames,
                  size_text(session), session.held_out, options.folder.string()));
}

void add_image_options(CLI::App& command, SynthOptions& options) {
  synthetic::SyntheticOptions& session = options.session;
  options.size = size_text(session);
  command.add_option("--size", options.size, "Image size in pixels")
      ->check([&session](const std::string& text) { return parse_size(text, session); })
      ->type_name("WxH")
      ->capture_default_str();
  command.add_option("--frames", session.frames, "Frames of the recording")
      ->check(CLI::Range(2, 100'000).description(""))
      ->type_name("N")
      ->capture_default_str();
  command
      .add_option("--held-out", session.held_out,
                  "Noise-free views apart from the recording, in held_out/; 0: none")
      ->check(CLI::Range(0, 10'000).description(""))
      ->type_name("N")
      ->capture_default_str();
  command
      .add_option("--samples", session.samples,
                  "Rays per pixel of a frame; held-out views take four times as many")
      ->check(CLI::Range(1, 256).description(""))
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--quality", session.jpeg_quality, "JPEG quality of the video, 1 to 100")
      ->check(CLI::Range(1, 100).description(""))
      ->type_name("Q")
      ->capture_default_str();
}

}  // namespace

void add_synth_command(CLI::App& program, CommandContext& context) {
  auto options = std::make_shared<SynthOptions>();
  synthetic::SyntheticOptions& session = options->session;
  CLI::App* command = program.add_subcommand(
      "synth", "Make a synthetic session: a known object, light and camera on a board of tags");
  command->footer("Example:\n  sheen synth glossy -o session --frames 120");
  const std::vector<std::string> names(synthetic::kSceneNames.begin(),
                                       synthetic::kSceneNames.end());
  command->add_option("scene", options->scene, "How the object's enamel shines")
      ->required()
      ->check(CLI::IsMember(names));
  command->add_option("-o,--output", options->folder, "Session folder to write")
      ->required()
      ->type_name("SESSION");
  command->add_option("--vertices", session.vertices, "Vertices of the object, about")
      ->check(CLI::Range(500, 2'000'000).description(""))
      ->type_name("N")
      ->capture_default_str();
  CLI::Option* mesh_vertices =
      command
          ->add_option("--mesh-vertices", session.mesh_vertices,
                       "Vertices of the session's mesh of the object, about; 0: as photographed")
          ->check(CLI::Range(0, 2'000'000).description(""))
          ->type_name("N")
          ->capture_default_str();
  command
      ->add_option("--mesh", options->mesh,
                   "Put this mesh on the board instead (metres, z up; PLY, OBJ or GLB)")
      ->excludes(mesh_vertices)
      ->type_name("FILE");
  add_image_options(*command, *options);
  command->add_option("--seed", session.seed, "Seed of path, tremor and noise")
      ->type_name("N")
      ->capture_default_str();
  add_common_options(*command, context);
  command->callback([options, &context] { run_synth(*options, context); });
}

}  // namespace sheen::app
