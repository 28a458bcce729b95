// SPDX-License-Identifier: MIT
#include "app/commands/mesh.h"

#include "app/commands/frame_options.h"
#include "app/commands/refine_by_print.h"
#include "app/commands/walk_session.h"
#include "app/session_lock.h"
#include "app/terminal_sink.h"
#include "capture/registration/registration_image.h"
#include "capture/session/keep_before.h"
#include "capture/session/new_session.h"
#include "capture/session/session_file.h"
#include "core/diagnostics/error.h"
#include "core/image/write_image.h"
#include "core/mesh/bounds.h"
#include "core/mesh/ply_file.h"
#include "pipeline/hold_out.h"
#include "pipeline/pose_frames.h"
#include "pipeline/posed_views.h"
#include "pipeline/session_readout.h"
#include "reconstruction/object/object_mesh.h"

#include <fmt/format.h>

#include <algorithm>

namespace sheen::app {
namespace {

constexpr std::size_t kMostImages = 120;
constexpr std::size_t kPictureViews = 6;

struct MeshOptions {
  std::filesystem::path session;
  std::filesystem::path output;
  std::filesystem::path image;
  pipeline::FrameChoice frames;
  int hold_out = 0;
  WalkOptions walk;
  bool force = false;
};

/// Where the mesh goes: into the session unless a file is named.
std::filesystem::path output_of(const MeshOptions& options) {
  return options.output.empty() ? options.session / "object.ply" : options.output;
}

/// A mesh that somebody brought is not lost to a command that was only tried.
void check_nothing_is_replaced(const MeshOptions& options, const capture::Session& session) {
  if (options.force) return;
  std::error_code no_throw;
  const auto output = output_of(options);
  if (options.output.empty() && !session.mesh.empty()) {
    throw core::bad_input(session.mesh, "is the session's mesh already",
                          "--force replaces it (and keeps it beside), -o FILE writes elsewhere");
  }
  if (std::filesystem::exists(output, no_throw)) {
    throw core::bad_input(output, "exists already",
                          "--force replaces it (and keeps it beside), -o FILE writes elsewhere");
  }
}

/// Images with poses, at most kMostImages spread evenly, without those kept out.
std::vector<reconstruction::PosedImage> read_images(const capture::Session& session,
                                                    const MeshOptions& options,
                                                    pipeline::ProgressSink& sink) {
  const pipeline::HoldOut hold_out{options.hold_out};
  std::vector<pipeline::PosedFrame> posed;
  for (const auto& frame : pipeline::pose_frames(session, options.frames, sink)) {
    if (!hold_out.contains(frame.index)) posed.push_back(frame);
  }
  std::vector<pipeline::PosedFrame> chosen;
  const std::size_t count = std::min(kMostImages, posed.size());
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(posed[i * posed.size() / count]);
  std::vector<reconstruction::PosedImage> images;
  pipeline::for_each_view(
      session, nullptr, chosen,
      [&](const capture::Frame& frame, const Eigen::Isometry3d& camera_from_board) {
        images.push_back({frame.index, frame.image.clone(), camera_from_board});
        sink.progress({"reading", static_cast<int>(images.size()), static_cast<int>(count)});
      });
  return images;
}

void draw_outlines(const MeshOptions& options, const capture::Session& session,
                   const core::Mesh& mesh, const std::vector<reconstruction::PosedImage>& images) {
  std::vector<capture::RegistrationView> views;
  std::vector<std::string> labels;
  const std::size_t count = std::min(kPictureViews, images.size());
  for (std::size_t i = 0; i < count; ++i) {
    const auto& image = images[i * images.size() / count];
    views.push_back({image.image, image.camera_from_board, 1});
    labels.push_back(fmt::format("frame {}", image.frame_index));
  }
  const Eigen::Isometry3d here = Eigen::Isometry3d::Identity();
  core::write_image(options.image,
                    capture::draw_registration(mesh, session.camera, views, labels, here, here));
}

/// Keeps a file that is about to be replaced. Returns the line that says so.
std::string kept(const std::filesystem::path& file) {
  std::error_code no_throw;
  if (!std::filesystem::is_regular_file(file, no_throw)) return {};
  return fmt::format("kept     {}\n", capture::keep_before(file, "mesh").string());
}

std::string save(const MeshOptions& options, const capture::Session& session,
                 const reconstruction::ObjectMesh& found) {
  const auto output = output_of(options);
  std::string lines = kept(output);
  if (options.output.empty()) {
    const auto session_file = options.session / "session.json";
    if (!session.mesh.empty()) lines += kept(session_file);
    core::write_ply(output, found.mesh, found.confidence);
    capture::write_object(session_file, session_file, output.filename().string());
  } else {
    core::write_ply(output, found.mesh, found.confidence);
  }
  return lines + fmt::format("written  {}\n", output.string());
}

double mean_of(const std::vector<float>& values) {
  double sum = 0;
  for (const float value : values) sum += static_cast<double>(value);
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

std::string describe(const reconstruction::ObjectMesh& found, const PrintRefinement& print) {
  const Eigen::Vector3d size_mm = 1e3 * core::bounds_of(found.mesh).sizes().cast<double>();
  return fmt::format(
      "mesh     {} triangles, edges of {:.2f} mm, a pixel is {:.2f} mm\n"
      "object   {:.0f} x {:.0f} x {:.0f} mm, {} views, {:.1f} % of their outlines' inside covered\n"
      "rims     seen at {:.0f} % of the surface, the rest is bounded from outside only\n"
      "print    {}\n",
      found.mesh.triangles.size(), 1e3 * static_cast<double>(found.edge_m),
      1e3 * static_cast<double>(found.pixel_m), size_mm.x(), size_mm.y(), size_mm.z(), found.views,
      100 * static_cast<double>(found.covered_share), 100 * mean_of(found.confidence),
      print.rounds == 0
          ? std::string("shows no better place of the surface that other views would confirm")
          : fmt::format("moved the surface in {} rounds, views kept out of that differ {:.0f} % "
                        "less from it",
                        print.rounds, 100 * (1 - print.residual_left)));
}

nlohmann::ordered_json to_json(const reconstruction::ObjectMesh& found,
                               const PrintRefinement& print) {
  const Eigen::Vector3d size_mm = 1e3 * core::bounds_of(found.mesh).sizes().cast<double>();
  return {{"triangles", found.mesh.triangles.size()},
          {"vertices", found.mesh.positions.size()},
          {"edge_mm", 1e3 * static_cast<double>(found.edge_m)},
          {"pixel_mm", 1e3 * static_cast<double>(found.pixel_m)},
          {"size_mm", {size_mm.x(), size_mm.y(), size_mm.z()}},
          {"views", found.views},
          {"covered_share", found.covered_share},
          {"hidden_share", found.hidden_share},
          {"confidence", mean_of(found.confidence)},
          {"print_rounds", print.rounds},
          {"print_residual_change", print.residual_left - 1}};
}

/// Measures the mesh of an open session and saves it.
MeshAnswer measure(const MeshOptions& options, capture::Session session,
                   pipeline::ProgressSink& sink, const CommandContext& context) {
  if (!session.board) {
    throw core::bad_input(options.session, "names no board, so there is no sheet to learn",
                          "film the object on a printed board (sheen board)");
  }
  const SessionLock lock(options.session, {output_of(options)});
  const capture::Board board = capture::read_board(*session.board);
  session.board_from_object = Eigen::Isometry3d::Identity();
  const auto images = read_images(session, options, sink);
  auto found = reconstruction::measure_object(options.session, session.camera, board, images,
                                              context.threads,
                                              [&sink](std::string_view step, int done, int total) {
                                                sink.progress({step, done, total});
                                              });
  const PrintRefinement print = refine_by_print(session, images, context.threads, sink, found.mesh);
  if (!options.image.empty()) draw_outlines(options, session, found.mesh, images);
  const std::string lines = save(options, session, found);
  return {to_json(found, print), describe(found, print) + lines};
}

void run_mesh(const MeshOptions& options, const CommandContext& context) {
  context.check_outputs({output_of(options), options.image});
  TerminalSink sink(context);
  check_nothing_is_replaced(options, capture::open_unfinished_session(options.session));
  WalkAnswer walk;
  capture::Session session = open_walk(options.session, options.walk, options.frames, sink, walk);
  for (const std::string& warning : session.warnings) context.note("note: " + warning);
  pipeline::complete_readout(session, options.frames, sink);
  MeshAnswer answer = measure(options, session, sink, context);
  if (!walk.document.is_null()) answer.document["walk"] = walk.document;
  context.publish(answer.document, walk.text + answer.text);
}

}  // namespace

MeshAnswer add_measured_mesh(const capture::Session& session, const pipeline::FrameChoice& frames,
                             pipeline::ProgressSink& sink, const CommandContext& context) {
  MeshOptions options;
  options.session = session.folder;
  options.frames = frames;
  options.frames.hold_out = 0;
  options.hold_out = frames.hold_out;
  check_nothing_is_replaced(options, session);
  return measure(options, session, sink, context);
}

void add_mesh_command(CommandLine& program, CommandContext& context) {
  auto options = std::make_shared<MeshOptions>();
  Command command = program.command(
      "mesh", "Measure the object's shape from the session's images: no scanner, no CAD model");
  command.example(
      "Examples:\n"
      "  sheen mesh SESSION                            write SESSION/object.ply and name it in\n"
      "                                                session.json\n"
      "  sheen mesh SESSION --picture check.png        look whether its outlines lie right\n"
      "  sheen mesh SESSION -o shape.ply               leave the session's mesh as it is\n"
      "With --force, what it replaces is kept: object.before-mesh.ply, session.before-mesh.json.");
  command.option("session", options->session, "Session folder, filmed on a board").required();
  command.option("-o,--output", options->output, "Write the mesh here, not into the session")
      .type("FILE.ply");
  command.option("--picture", options->image, "Also draw the mesh's outline over six frames")
      .type("FILE.png");
  command.flag("--force", options->force, "Replace a mesh that is there; the old one is kept");
  command
      .option("--hold-out", options->hold_out,
              "Do not look at the frames that replay --hold-out N keeps out; 0: look at all")
      .not_negative()
      .show_default();
  add_walk_options(command, options->walk);
  add_frame_options(command, options->frames);
  add_common_options(command, context);
  command.action([options, &context] { run_mesh(*options, context); });
}

}  // namespace sheen::app
