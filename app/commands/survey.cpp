// SPDX-License-Identifier: MIT
#include "app/commands/survey.h"

#include "app/session_lock.h"
#include "app/terminal_sink.h"
#include "capture/calibration/camera_file.h"
#include "capture/pose/board_change.h"
#include "capture/session/keep_before.h"
#include "core/diagnostics/error.h"
#include "core/image/write_image.h"
#include "pipeline/session_board.h"
#include "pipeline/session_mesh.h"

#include <fmt/format.h>

#include <numbers>

namespace sheen::app {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr double kImplausibleShift_m = 0.005;  // paper curls and glue slips by less

struct SurveyOptions {
  std::filesystem::path session;
  std::filesystem::path output;
  std::filesystem::path camera_output;
  std::filesystem::path image;
  int start = 0;
  std::optional<int> end;
};

/// What the survey found, in one number each.
struct Summary {
  double largest_mm = 0;
  int largest_id = 0;
  double height_mm = 0;  ///< from the lowest to the highest centre
  double tilt_deg = 0;   ///< the largest
};

Summary summarise(const capture::BoardRefinement& found,
                  const std::vector<capture::TagChange>& changes) {
  Summary summary;
  double low = 0;
  double high = 0;
  for (const capture::TagChange& change : changes) {
    const double shift_mm = 1e3 * change.shift_m.norm();
    if (shift_mm > summary.largest_mm) {
      summary.largest_mm = shift_mm;
      summary.largest_id = change.id;
    }
    summary.tilt_deg = std::max(summary.tilt_deg, kDegrees * change.tilt_rad);
    const double z = found.board.tags.at(change.id).board_from_tag.translation().z();
    low = std::min(low, z);
    high = std::max(high, z);
  }
  summary.height_mm = 1e3 * (high - low);
  return summary;
}

std::string describe(const capture::BoardRefinement& found,
                     const std::vector<capture::TagChange>& changes) {
  const Summary summary = summarise(found, changes);
  std::string text = fmt::format(
      "before   {:.2f} px RMS over the tags' corners\n"
      "after    {:.2f} px, {} views, {} tags\n"
      "moved    {:.2f} mm (median), {:.2f} mm at most (tag {}); heights span {:.2f} mm, tilt up to "
      "{:.2f} degrees\n\n"
      "   tag     x mm     y mm     z mm  tilt deg\n",
      found.rms_before_px, found.rms_after_px, found.views, found.tags, 1e3 * found.median_shift_m,
      summary.largest_mm, summary.largest_id, summary.height_mm, summary.tilt_deg);
  for (const capture::TagChange& change : changes) {
    text +=
        fmt::format("{:6} {:8.2f} {:8.2f} {:8.2f} {:9.2f}\n", change.id, 1e3 * change.shift_m.x(),
                    1e3 * change.shift_m.y(), 1e3 * change.shift_m.z(), kDegrees * change.tilt_rad);
  }
  return text + "\n";
}

nlohmann::ordered_json to_json(const capture::BoardRefinement& found,
                               const std::vector<capture::TagChange>& changes) {
  nlohmann::ordered_json tags = nlohmann::ordered_json::array();
  for (const capture::TagChange& change : changes) {
    const Eigen::Vector3d shift_mm = 1e3 * change.shift_m;
    tags.push_back({{"id", change.id},
                    {"shift_mm", {shift_mm.x(), shift_mm.y(), shift_mm.z()}},
                    {"tilt_deg", kDegrees * change.tilt_rad}});
  }
  const auto& lens = found.camera.intrinsics();
  return {{"views", found.views},
          {"tags", found.tags},
          {"rms_before_px", found.rms_before_px},
          {"rms_after_px", found.rms_after_px},
          {"median_shift_mm", 1e3 * found.median_shift_m},
          {"focal_px", {lens.focal_px.x(), lens.focal_px.y()}},
          {"principal_px", {lens.principal_px.x(), lens.principal_px.y()}},
          {"distortion", lens.distortion},
          {"changes", tags}};
}

/// Writes a file; one of that name is kept beside it first. Returns the lines that say so.
template <typename Write>
std::string write_keeping(const std::filesystem::path& path, const Write& write) {
  std::string lines;
  std::error_code no_throw;
  if (std::filesystem::is_regular_file(path, no_throw)) {
    lines = fmt::format("kept     {}\n", capture::keep_before(path, "survey").string());
  }
  write();
  return fmt::format("written  {}\n", path.string()) + lines;
}

void run_survey(SurveyOptions options, const CommandContext& context) {
  if (options.output.empty()) options.output = options.session / "board.surveyed.yaml";
  context.check_outputs({options.output, options.camera_output, options.image});
  capture::Session session = capture::open_session(options.session);
  const SessionLock lock(options.session, {options.output, options.camera_output});
  for (const std::string& warning : session.warnings) context.note("note: " + warning);
  const auto lens =
      options.camera_output.empty() ? capture::LensRefinement::off : capture::LensRefinement::on;
  TerminalSink sink(context);
  const core::Mesh mesh = pipeline::read_session_mesh(session, sink);
  const pipeline::SessionScene scene(session, mesh, pipeline::PoseSource::tags, sink);
  const auto found =
      pipeline::refine_session_board(session, options.start, options.end, sink, lens);
  if (!found) {
    throw core::bad_input(options.session, "its images do not tell where the tags lie",
                          "record at least three views with two or more tags each");
  }

  const capture::Board given = capture::read_board(*session.board);
  const auto changes = capture::compare_boards(given, found->board);
  std::string written =
      write_keeping(options.output, [&] { capture::write_board(options.output, found->board); });
  if (!options.camera_output.empty()) {
    written += write_keeping(options.camera_output,
                             [&] { capture::write_camera(options.camera_output, found->camera); });
  }
  if (!options.image.empty()) {
    core::write_image(options.image, capture::draw_board_change(given, found->board));
  }
  if (found->median_shift_m > kImplausibleShift_m) {
    context.note("note: tags lie far from where the board says; check its sizes with a ruler");
  }
  context.publish(to_json(*found, changes), describe(*found, changes) + written);
}

}  // namespace

void add_survey_command(CommandLine& program, CommandContext& context) {
  auto options = std::make_shared<SurveyOptions>();
  Command command = program.command(
      "survey", "Find where the tags really lie: paper curls, tags are stuck by hand");
  command.example(
      "Examples:\n"
      "  sheen survey SESSION                          write SESSION/board.surveyed.yaml and "
      "compare\n"
      "  sheen survey SESSION -o SESSION/board.yaml    use it; the old one stays as\n"
      "                                                board.before-survey.yaml\n"
      "  sheen survey SESSION --refine-camera SESSION/camera.yaml    the lens, too");
  command.option("session", options->session, "Session folder").required();
  command
      .option("-o,--output", options->output,
              "Board to write (default: board.surveyed.yaml in the session)")
      .type("FILE.yaml");
  command
      .option("--refine-camera", options->camera_output,
              "Refine the lens, too, and write it here; wants views from many tilts")
      .type("FILE.yaml");
  command.option("--picture", options->image, "Also draw the board from above, before and after")
      .type("FILE.png");
  command.option("--start", options->start, "First frame").not_negative().show_default();
  command.option("--end", options->end, "One past the last frame (default: all)").positive();
  add_common_options(command, context);
  command.action([options, &context] { run_survey(*options, context); });
}

}  // namespace sheen::app
