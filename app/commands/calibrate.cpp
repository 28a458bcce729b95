// SPDX-License-Identifier: MIT
#include "app/commands/calibrate.h"

#include "app/interrupt.h"
#include "capture/calibration/calibrate_camera.h"
#include "capture/calibration/calibration_images.h"
#include "capture/calibration/camera_file.h"
#include "capture/calibration/camera_images.h"
#include "capture/calibration/coverage_image.h"
#include "capture/pose/board_diagnosis.h"
#include "capture/source/network_address.h"
#include "capture/source/open_camera.h"
#include "core/diagnostics/error.h"
#include "core/image/write_image.h"

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include <cstdio>
#include <numbers>

namespace sheen::app {
namespace {

constexpr std::size_t kMostCandidates = 120;

struct CalibrateOptions {
  std::filesystem::path source;
  std::filesystem::path output;
  std::filesystem::path board;
  std::filesystem::path image;
  std::string chessboard;
  double square_mm = 25;
  bool is_fisheye = false;
  int views = 40;
  double seconds = 40;
};

/// Views of the target with their images, which are needed once more when the lens is known.
struct Candidates {
  std::vector<capture::TargetView> views;
  std::vector<cv::Mat> images;
  capture::ImageSize size;
  int frames = 0;

  /// Keeps every second: the source is longer than needed.
  void thin_out() {
    const std::size_t half = (views.size() + 1) / 2;
    for (std::size_t i = 1; i < half; ++i) {
      views[i] = std::move(views[2 * i]);
      images[i] = images[2 * i];
    }
    views.resize(half);
    images.resize(half);
  }
};

/// "9x6": inner corners across and down; empty when it is fine, else what is wrong.
std::string parse_chessboard(const std::string& text, capture::Chessboard& board) {
  int used = 0;
  const bool complete =
      std::sscanf(text.c_str(), "%3dx%3d%n", &board.columns, &board.rows, &used) == 2 &&
      static_cast<std::size_t>(used) == text.size();
  if (!complete || board.columns < 3 || board.rows < 3) {
    return "must be COLUMNSxROWS of inner corners, for instance 9x6";
  }
  return {};
}

capture::CalibrationTarget target_of(const CalibrateOptions& options) {
  if (!options.board.empty()) return capture::read_board(options.board);
  capture::Chessboard chessboard;
  parse_chessboard(options.chessboard, chessboard);
  chessboard.square_m = options.square_mm / 1000;
  return chessboard;
}

bool is_device(const CalibrateOptions& options) {
  const std::string source = options.source.string();
  return source.starts_with("/dev/") || capture::is_network_address(source);
}

/// An address without its password.
std::filesystem::path shown_source(const CalibrateOptions& options) {
  return capture::shown_address(options.source.string());
}

/// A device is watched for a while; anything else is read to its end.
std::unique_ptr<capture::FrameSource> open_images(const CalibrateOptions& options) {
  if (!is_device(options)) {
    return capture::open_calibration_images(options.source);
  }
  capture::V4l2CameraOptions camera;
  camera.device = options.source;
  return capture::open_camera_images(capture::open_camera(camera), options.seconds);
}

Candidates find_candidates(const CalibrateOptions& options, capture::TargetFinder& finder,
                           const CommandContext& context) {
  const auto frames = open_images(options);
  Progress progress = context.progress("looking for the target", frames->frame_count().value_or(0));
  Candidates candidates;
  int stride = 1;
  while (const auto frame = frames->next()) {
    throw_if_interrupted();
    progress.show(++candidates.frames, fmt::format("{} found", candidates.views.size()));
    candidates.size = {frame->image.cols, frame->image.rows};
    if (frame->index % stride != 0) continue;
    cv::Mat grey;
    cv::cvtColor(frame->image, grey, cv::COLOR_BGR2GRAY);
    auto view = finder.find(grey);
    if (!view) continue;
    view->frame_index = frame->index;
    candidates.views.push_back(std::move(*view));
    candidates.images.push_back(grey);
    if (candidates.views.size() < kMostCandidates) continue;
    candidates.thin_out();
    stride *= 2;
  }
  const capture::SourceReport report = frames->report();
  for (const std::string& note : report.notes) context.note("note: " + note);
  if (report.damaged > 0) {
    context.note(fmt::format("note: {}: {} damaged images were left out",
                             shown_source(options).string(), report.damaged));
  }
  return candidates;
}

/// Calibrates, measures the points again through the lens that was found, calibrates again.
std::optional<capture::Calibration> calibrate(const CalibrateOptions& options,
                                              const capture::TargetFinder& finder,
                                              const Candidates& candidates, core::LensKind lens) {
  auto views = capture::choose_spread_views(candidates.views, candidates.size,
                                            static_cast<std::size_t>(options.views));
  const auto first = capture::calibrate_camera(views, candidates.size, lens);
  if (!first) return std::nullopt;
  for (capture::TargetView& view : views) {
    for (std::size_t i = 0; i < candidates.views.size(); ++i) {
      if (candidates.views[i].frame_index != view.frame_index) continue;
      finder.refine(candidates.images[i], first->camera, view);
    }
  }
  return capture::calibrate_camera(views, candidates.size, lens);
}

std::string describe(const capture::Calibration& found) {
  const auto& lens = found.camera.intrinsics();
  const auto& k = lens.distortion;
  const std::string terms =
      lens.lens == core::LensKind::fisheye
          ? fmt::format("k1 {:.5f}  k2 {:.5f}  k3 {:.5f}  k4 {:.5f} (fisheye)", k[0], k[1], k[2],
                        k[3])
          : fmt::format("k1 {:.5f}  k2 {:.5f}  p1 {:.5f}  p2 {:.5f}  k3 {:.5f}", k[0], k[1], k[2],
                        k[3], k[4]);
  std::string text = fmt::format(
      "focal      {:.2f} {:.2f} px  (+- {:.2f} {:.2f})\n"
      "principal  {:.2f} {:.2f} px  (+- {:.2f} {:.2f})\n"
      "distortion {}\n"
      "error      {:.3f} px RMS over {} views\n"
      "coverage   {:.0f} % of the image area; tilts differ by up to {:.0f} degrees\n\n"
      " frame  points  error px\n",
      lens.focal_px.x(), lens.focal_px.y(), found.focal_sigma_px.x(), found.focal_sigma_px.y(),
      lens.principal_px.x(), lens.principal_px.y(), found.principal_sigma_px.x(),
      found.principal_sigma_px.y(), terms, found.rms_px, found.views.size(), 100 * found.coverage,
      found.tilt_spread_rad * 180 / std::numbers::pi);
  for (const auto& view : found.views) {
    text += fmt::format("{:6} {:7} {:9.3f}\n", view.points.frame_index,
                        view.points.on_target.size(), view.rms_px);
  }
  if (!found.dropped.empty()) {
    text += fmt::format("left out, far worse than the others: {}\n", fmt::join(found.dropped, " "));
  }
  return text + "\n";
}

nlohmann::ordered_json to_json(const capture::Calibration& found, int frames) {
  nlohmann::ordered_json views = nlohmann::ordered_json::array();
  for (const auto& view : found.views) {
    views.push_back({{"frame", view.points.frame_index},
                     {"points", view.points.on_target.size()},
                     {"rms_px", view.rms_px}});
  }
  const auto& lens = found.camera.intrinsics();
  return {{"size_px", {lens.width_px, lens.height_px}},
          {"focal_px", {lens.focal_px.x(), lens.focal_px.y()}},
          {"focal_sigma_px", {found.focal_sigma_px.x(), found.focal_sigma_px.y()}},
          {"principal_px", {lens.principal_px.x(), lens.principal_px.y()}},
          {"principal_sigma_px", {found.principal_sigma_px.x(), found.principal_sigma_px.y()}},
          {"lens", lens.lens == core::LensKind::fisheye ? "fisheye" : "rational"},
          {"distortion", lens.distortion},
          {"rms_px", found.rms_px},
          {"coverage", found.coverage},
          {"tilt_spread_deg", found.tilt_spread_rad * 180 / std::numbers::pi},
          {"frames_read", frames},
          {"views", views},
          {"dropped", found.dropped}};
}

/// Looks for the fault at the board: throws core::Error (bad_input) where it finds one.
void diagnose_board(const CalibrateOptions& options, const Candidates& candidates) {
  if (options.board.empty() || is_device(options) || candidates.frames == 0) return;
  constexpr int most = 8;
  const int stride = std::max(1, candidates.frames / most);
  const auto frames = capture::open_calibration_images(options.source);
  std::optional<capture::BoardDiagnosis> diagnosis;
  for (int i = 0; i < most * stride; ++i) {
    const auto frame = frames->next();
    if (!frame) break;
    if (!diagnosis) {
      diagnosis.emplace(capture::read_board(options.board),
                        capture::plain_camera({frame->image.cols, frame->image.rows}));
    }
    if (i % stride == 0) diagnosis->look_at(*frame);
  }
  if (!diagnosis) return;
  const bool has_found = candidates.views.size() > static_cast<std::size_t>(candidates.frames / 4);
  const capture::PoseCause cause = diagnosis->cause(has_found ? capture::PoseRejection::reprojection
                                                              : capture::PoseRejection::no_tags);
  // Of a lens that is not known yet nothing can be said.
  if (cause.suspect == capture::PoseSuspect::camera || !cause.is_sure) return;
  throw core::bad_input(
      cause.suspect == capture::PoseSuspect::board ? options.board : shown_source(options),
      fmt::format("{}; {} of {} images show the target", cause.fault, candidates.views.size(),
                  candidates.frames),
      cause.remedy);
}

core::LensKind other_kind(core::LensKind lens) {
  return lens == core::LensKind::fisheye ? core::LensKind::rational : core::LensKind::fisheye;
}

/// Refuses the kind of lens that was asked for where the other one explains the images far better.
void judge_lens(const CalibrateOptions& options, core::LensKind lens,
                const std::optional<capture::Calibration>& found,
                const std::optional<capture::Calibration>& other, const CommandContext& context) {
  const auto doubt = capture::doubt_lens(lens, found, other, {});
  if (!doubt) return;
  if (doubt->is_sure) throw core::bad_input(shown_source(options), doubt->fault, doubt->remedy);
  context.note(
      fmt::format("note: {}: {}; {}", shown_source(options).string(), doubt->fault, doubt->remedy));
}

[[noreturn]] void refuse(const CalibrateOptions& options, const Candidates& candidates,
                         const std::string& faults) {
  diagnose_board(options, candidates);
  throw core::bad_input(shown_source(options), "cannot be calibrated from: " + faults,
                        "move the target through the whole image, near and far, tilted to all "
                        "sides by 30 degrees");
}

void run_calibrate(const CalibrateOptions& options, const CommandContext& context) {
  context.check_outputs({options.output, options.image});
  const auto finder = capture::make_target_finder(target_of(options));
  const Candidates candidates = find_candidates(options, *finder, context);
  const core::LensKind lens =
      options.is_fisheye ? core::LensKind::fisheye : core::LensKind::rational;
  const auto found = calibrate(options, *finder, candidates, lens);
  judge_lens(options, lens, found, calibrate(options, *finder, candidates, other_kind(lens)),
             context);
  if (!found) {
    refuse(
        options, candidates,
        fmt::format("{} of {} images show the target", candidates.views.size(), candidates.frames));
  }
  if (!options.image.empty()) core::write_image(options.image, capture::draw_coverage(*found));
  if (const auto faults = capture::find_faults(*found, {}); !faults.empty()) {
    refuse(options, candidates, fmt::format("{}", fmt::join(faults, "; ")));
  }
  capture::write_camera(options.output, found->camera);
  context.publish(to_json(*found, candidates.frames),
                  describe(*found) + fmt::format("written  {}\n", options.output.string()));
}

void add_target_options(Command command, CalibrateOptions& options) {
  Command target = command.exactly_one_of("target", "What the images show");
  target.option("--board", options.board, "A board of tags, such as sheen board prints")
      .type("FILE.yaml");
  target
      .option("--chessboard", options.chessboard,
              "A chessboard with this many inner corners across and down")
      .check([](const std::string& text) {
        capture::Chessboard board;
        return parse_chessboard(text, board);
      })
      .type("COLUMNSxROWS");
  command.option("--square-mm", options.square_mm, "Side of the chessboard's squares")
      .range(0.1, 10'000.0)
      .type("MM")
      .show_default();
}

}  // namespace

void add_calibrate_command(CommandLine& program, CommandContext& context) {
  auto options = std::make_shared<CalibrateOptions>();
  Command command = program.command(
      "calibrate", "Measure a camera's lens from images of a printed board or chessboard");
  command.example(
      "Examples:\n"
      "  sheen board -o grid.pdf --full --tag-mm 25\n"
      "  sheen calibrate walk.mp4 --board grid.yaml -o camera.yaml --picture coverage.png\n"
      "  sheen calibrate /dev/video0 --board grid.yaml -o camera.yaml    for 40 s, from the "
      "camera\n"
      "  sheen calibrate photos/ --chessboard 9x6 --square-mm 25 -o camera.yaml\n"
      "  sheen calibrate action-camera.mp4 --fisheye --board grid.yaml -o camera.yaml\n"
      "Lock focus and zoom first. Move the target through the whole image, its corners too,\n"
      "near and far, tilted to all sides by 30 degrees and more.");
  command
      .option("source", options->source,
              "Video, folder of images, session folder (its recording is taken), or a camera: a "
              "device such as /dev/video0, the address of an MJPEG (http://...) or H.264 stream "
              "(rtsp://...)")
      .required();
  command.option("-o,--output", options->output, "Camera file to write")
      .required()
      .type("camera.yaml");
  add_target_options(command, *options);
  command.flag("--fisheye", options->is_fisheye,
               "The lens is a fisheye, of 120 degrees and more (OpenCV's fisheye, k1 to k4)");
  command.option("--views", options->views, "Images to calibrate from, chosen for spread")
      .range(3, 100)
      .type("N")
      .show_default();
  command.option("--seconds", options->seconds, "How long a camera's device is watched")
      .range(5.0, 3600.0)
      .type("S")
      .show_default();
  command
      .option("--picture", options->image,
              "Also draw where points were seen and by how much they miss")
      .type("FILE.png");
  add_common_options(command, context);
  command.action([options, &context] { run_calibrate(*options, context); });
}

}  // namespace sheen::app
