// SPDX-License-Identifier: MIT
#include "app/commands/register.h"

#include "app/commands/frame_options.h"
#include "app/interrupt.h"
#include "app/session_lock.h"
#include "app/terminal_sink.h"
#include "capture/registration/placement.h"
#include "capture/registration/registration.h"
#include "capture/registration/registration_image.h"
#include "capture/registration/upright_turn.h"
#include "capture/registration/view_choice.h"
#include "capture/session/keep_before.h"
#include "capture/session/session.h"
#include "capture/session/session_file.h"
#include "core/diagnostics/error.h"
#include "core/image/write_image.h"
#include "core/mesh/bounds.h"
#include "pipeline/pose_frames.h"
#include "pipeline/session_mesh.h"

#include <fmt/format.h>

#include <map>
#include <numbers>

namespace sheen::app {
namespace {

constexpr std::size_t kImageViews = 6;
constexpr double kTrustedShare = 0.75;  // of the outline on edges: recordings that fit reach 0.9

struct RegisterOptions {
  std::filesystem::path session;
  pipeline::FrameChoice frames;
  std::filesystem::path output;
  std::filesystem::path pairs;
  std::filesystem::path image;
  std::string guess = "session";
  double search_mm = 20;
  int views = 40;
};

/// The chosen images with their cameras, and which frames they are.
struct Views {
  std::vector<capture::RegistrationView> views;
  std::vector<int> frame_indices;
};

Views read_views(const capture::Session& session, const RegisterOptions& options,
                 const std::vector<capture::ChosenView>& chosen) {
  Views result;
  const auto frames = capture::open_frames(session, options.frames.start, options.frames.end);
  auto next = chosen.begin();
  while (next != chosen.end()) {
    const auto frame = frames->next();
    if (!frame) break;
    throw_if_interrupted();
    if (frame->index != next->frame.index) continue;
    result.views.push_back({frame->image.clone(), next->frame.camera_from_board, next->weight});
    result.frame_indices.push_back(frame->index);
    ++next;
  }
  return result;
}

std::string describe(const capture::Registration& found) {
  constexpr double degrees = 180 / std::numbers::pi;
  return fmt::format(
      "residual    {:.2f} px (median), {:.0f} % of the outline on an edge, {} views\n"
      "moved       {:.2f} mm and {:.2f} degrees ({:.1f} px in the images)\n"
      "uncertainty {:.3f} mm and {:.3f} degrees (standard deviation, worst direction)\n",
      found.residual_px, 100 * found.matched_share, found.views, 1e3 * found.translation_m,
      degrees * found.rotation_rad, found.motion_px, 1e3 * found.sigma_m,
      degrees * found.sigma_rad);
}

nlohmann::ordered_json to_json(const capture::Registration& found) {
  constexpr double degrees = 180 / std::numbers::pi;
  std::vector<double> numbers;
  for (int i = 0; i < 16; ++i) numbers.push_back(found.board_from_object.matrix()(i / 4, i % 4));
  return {{"T_stage_object", numbers},
          {"residual_px", found.residual_px},
          {"matched_share", found.matched_share},
          {"views", found.views},
          {"points", found.points},
          {"moved",
           {{"mm", 1e3 * found.translation_m},
            {"degrees", degrees * found.rotation_rad},
            {"px", found.motion_px}}},
          {"sigma", {{"mm", 1e3 * found.sigma_m}, {"degrees", degrees * found.sigma_rad}}}};
}

void write_image(const RegisterOptions& options, const capture::Session& session,
                 const core::Mesh& mesh, const Views& views, const Eigen::Isometry3d& before,
                 const capture::Registration& found) {
  std::vector<std::string> labels;
  for (std::size_t v = 0; v < views.views.size(); ++v) {
    labels.push_back(
        fmt::format("frame {}{}", views.frame_indices[v], found.agrees[v] ? "" : ", set aside"));
  }
  core::write_image(options.image,
                    capture::draw_registration(mesh, session.camera,
                                               capture::thinned_out(views.views, kImageViews),
                                               capture::thinned_out(labels, kImageViews), before,
                                               found.board_from_object));
}

/// Where the search begins: picked pairs, upright on the board, or what the session says.
Eigen::Isometry3d first_guess(const RegisterOptions& options, const capture::Session& session,
                              const core::Mesh& mesh, const CommandContext& context) {
  if (!options.pairs.empty()) {
    const auto placement =
        capture::place_by_pairs(capture::read_point_pairs(options.pairs), options.pairs);
    context.note(fmt::format("note: the pairs fit each other to {:.1f} mm", 1e3 * placement.rms_m));
    return placement.board_from_object * Eigen::Translation3d(mesh.offset);
  }
  if (options.guess == "upright") return capture::place_upright(mesh, 0);
  return session.board_from_object;
}

/// Poses the recording and chooses the frames to look at. Throws core::Error (bad_input) for a
/// scene that cannot be: nothing is registered in the wrong unit.
std::vector<capture::ChosenView> choose_frames(capture::Session session,
                                               const RegisterOptions& options, core::Mesh& mesh,
                                               const Eigen::Isometry3d& guess,
                                               const CommandContext& context) {
  TerminalSink sink(context);
  session.board_from_object = guess;
  const auto frames = pipeline::pose_frames(session, options.frames, sink);
  pipeline::SessionScene::check(session, mesh, options.frames.pose_source, frames, sink);
  std::vector<capture::PosedFrameIndex> posed;
  std::vector<Eigen::Isometry3d> poses;
  for (const pipeline::PosedFrame& frame : frames) {
    posed.push_back({frame.index, frame.camera_from_board});
    poses.push_back(frame.camera_from_board);
  }
  pipeline::face_cameras(mesh, session, poses, sink);
  return capture::choose_views(
      posed, session.camera, guess * core::bounds_of(mesh).center().cast<double>(), options.views);
}

/// Writes session.json with the new place; the one it replaces is kept. Returns the lines that say
/// so.
std::string save(const std::filesystem::path& session_file, const std::filesystem::path& output,
                 const Eigen::Isometry3d& board_from_object) {
  std::string kept;
  std::error_code no_throw;
  if (std::filesystem::equivalent(output, session_file, no_throw)) {
    kept = fmt::format("kept        {}\n", capture::keep_before(session_file, "register").string());
  }
  capture::write_board_from_object(session_file, output, board_from_object);
  return fmt::format("written     {}\n", output.string()) + kept;
}

void run_register(const RegisterOptions& options, const CommandContext& context) {
  const auto session_file = options.session / "session.json";
  const auto output = options.output.empty() ? session_file : options.output;
  context.check_outputs({output, options.image});
  capture::Session session = capture::open_session(options.session);
  const SessionLock lock(options.session, {output});
  for (const std::string& warning : session.warnings) context.note("note: " + warning);
  TerminalSink sink(context);
  core::Mesh mesh = pipeline::read_session_mesh(session, sink);

  // Guess, then align.
  Eigen::Isometry3d guess = first_guess(options, session, mesh, context);
  const auto chosen = choose_frames(session, options, mesh, guess, context);
  const Views views = read_views(session, options, chosen);
  if (options.pairs.empty() && options.guess == "upright") {
    guess = capture::find_upright_turn(mesh, session.camera, views.views, throw_if_interrupted);
  }
  auto found = capture::register_object(mesh, session.camera, views.views, guess,
                                        {.search_m = options.search_mm / 1000});
  if (!found) {
    throw core::bad_input(options.session, "the object's outline finds too few edges",
                          "give a better start by --pairs or a larger --search-mm");
  }

  // Save.
  if (!options.image.empty()) write_image(options, session, mesh, views, guess, *found);
  found->board_from_object = found->board_from_object * Eigen::Translation3d(-mesh.offset);
  const std::string lines = save(session_file, output, found->board_from_object);
  if (found->matched_share < kTrustedShare) {
    context.note(
        fmt::format("note: only {:.0f} % of the outline lies on edges; look at --picture, "
                    "and whether board and mesh are in metres",
                    100 * found->matched_share));
  }
  context.publish(to_json(*found), describe(*found) + lines);
}

void add_register_options(Command command, RegisterOptions& options) {
  command.option("session", options.session, "Session folder").required();
  command
      .option("-o,--output", options.output,
              "Write the changed session.json here (default: into the session)")
      .type("FILE");
  command.option("--guess", options.guess, "Where to start: session or upright")
      .one_of({"session", "upright"})
      .show_default();
  command.option("--pairs", options.pairs, "Start from three or more picked pairs of points")
      .type("FILE");
  command.option("--search-mm", options.search_mm, "How far the outline may be off at the start")
      .range(1.0, 200.0)
      .type("MM")
      .show_default();
  command.option("--views", options.views, "Frames to look at, spread over the recording")
      .range(3, 1000)
      .type("N")
      .show_default();
  command
      .option("--picture", options.image, "Also draw the outline over six frames, before and after")
      .type("FILE.png");
}

}  // namespace

void add_register_command(CommandLine& program, CommandContext& context) {
  auto options = std::make_shared<RegisterOptions>();
  Command command = program.command(
      "register", "Find where the mesh stands on the board: lay its outline on the images' edges");
  command.example(
      "Examples:\n"
      "  sheen register SESSION --picture check.png      improve session.json's T_stage_object\n"
      "  sheen register SESSION --guess upright          z up, near the board's centre, any turn\n"
      "  sheen register SESSION --pairs picked.txt       start from picked points; one a line:\n"
      "                                                  x y z in the mesh  x y z on the board\n"
      "The session.json it replaces is kept as session.before-register.json.");
  add_register_options(command, *options);
  add_frame_options(command, options->frames);
  add_common_options(command, context);
  command.action([options, &context] { run_register(*options, context); });
}

}  // namespace sheen::app
