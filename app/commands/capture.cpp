// SPDX-License-Identifier: MIT
#include "app/commands/capture.h"

#include "app/commands/camera_list.h"
#include "app/commands/replay.h"
#include "app/interrupt.h"
#include "app/preview/run_preview.h"
#include "app/terminal_sink.h"
#include "app/walk/walk_model.h"
#include "capture/calibration/calibration_target.h"
#include "capture/pose/board.h"
#include "capture/session/camera_recording.h"
#include "capture/session/session.h"
#include "capture/source/network_address.h"
#include "capture/source/open_camera.h"
#include "core/diagnostics/error.h"
#include "core/files/folder_lock.h"
#include "pipeline/session_mesh.h"
#include "reconstruction/live/live_hull.h"
#include "reconstruction/live/live_walk.h"

#include <fmt/format.h>

#include <atomic>
#include <optional>
#include <utility>

namespace sheen::app {
namespace {

std::string size_text(int width_px, int height_px) {
  return fmt::format("{}x{}", width_px, height_px);
}

/// Raw images share chroma between pairs of pixels, NV12 between pairs of rows too.
bool can_be_recorded(const capture::CameraDescription& camera) {
  switch (camera.format) {
    case capture::PixelFormat::mjpeg:
    case capture::PixelFormat::video:
      return true;
    case capture::PixelFormat::yuyv:
      return camera.width_px % 2 == 0;
    case capture::PixelFormat::nv12:
      return camera.width_px % 2 == 0 && camera.height_px % 2 == 0;
  }
  return false;
}

void check_size(const capture::CameraDescription& camera, const capture::SessionSetup& setup) {
  if (!can_be_recorded(camera)) {
    throw core::bad_input(camera.device,
                          fmt::format("delivers raw images of odd size, {}",
                                      size_text(camera.width_px, camera.height_px)),
                          "choose an even --size or --format mjpeg");
  }
  const core::CameraModel& model = setup.camera;
  if (camera.width_px == model.width_px() && camera.height_px == model.height_px()) return;
  throw core::bad_input(camera.device,
                        fmt::format("delivers {} but the camera file is for {}",
                                    size_text(camera.width_px, camera.height_px),
                                    size_text(model.width_px(), model.height_px())),
                        "choose that --size or calibrate at this one");
}

/// Whether images can be fitted as they come; else they are when all of them are there.
bool is_complete(const capture::SessionSetup& setup) {
  return !setup.camera_is_guessed && !setup.board.empty() && !setup.mesh.empty();
}

void check_scene(const CaptureOptions& options, const capture::SessionSetup& setup) {
  capture::Session scene;
  scene.folder = options.session;
  scene.camera = setup.camera;
  scene.board = setup.board;
  scene.mesh = setup.mesh;
  scene.board_from_object = setup.board_from_object;
  pipeline::ProgressSink silent;  // the fit says the same again
  const core::Mesh mesh = pipeline::read_session_mesh(scene, silent);
  static_cast<void>(pipeline::SessionScene(scene, mesh, pipeline::PoseSource::tags, silent));
}

/// Whatever may be wrong shows before the folder is made: a failed start would leave it behind, and
/// the next one would have to go elsewhere.
void check_before_recording(const CaptureOptions& options, const capture::SessionSetup& setup,
                            const CommandContext& context) {
  if (is_complete(setup)) {
    check_scene(options, setup);
  } else {
    if (!setup.board.empty()) static_cast<void>(capture::read_board(setup.board));
    if (!setup.mesh.empty()) static_cast<void>(pipeline::read_object_mesh(setup.mesh));
  }
  context.check_outputs({options.fit.output});
  if (options.fit.preview) check_display();
}

capture::RecordingTerms terms_of(const CaptureOptions& options, const CommandContext& context,
                                 const std::atomic<bool>& window_closed) {
  return {.frames = options.frames,
          .seconds = options.seconds,
          .is_enough =
              [&window_closed] { return FinishOnInterrupt::wants_to_finish() || window_closed; },
          .on_disk_fault = [&context](const core::Error& fault) { context.note(fault.what()); }};
}

nlohmann::ordered_json to_json(const CaptureOptions& options,
                               const capture::RecordingStatus& status) {
  return {{"session", options.session.string()},
          {"device", status.description.device},
          {"camera", status.description.name},
          {"taken", status.taken},
          {"recorded", status.recorded},
          {"lost", status.camera.lost},
          {"damaged", status.camera.damaged + status.unreadable},
          {"dropped", status.dropped},
          {"reconnections", status.camera.reconnections},
          {"complete", !status.disk_fault && !status.camera_fault}};
}

std::string to_text(const CaptureOptions& options, const capture::RecordingStatus& status) {
  std::string text = fmt::format("recorded {} of {} images from {}", status.recorded, status.taken,
                                 status.description.name);
  const std::pair<int, const char*> troubles[] = {
      {status.camera.lost, "lost by the camera"},
      {status.camera.damaged + status.unreadable, "damaged"},
      {status.dropped, "dropped, the disk was too slow"},
      {status.camera.reconnections, "reconnections"}};
  for (const auto& [count, name] : troubles) {
    if (count > 0) text += fmt::format(", {} {}", count, name);
  }
  return text + fmt::format("\nsession  {}\n", options.session.string());
}

/// Fits what comes; a camera that failed says more than that there was nothing to fit.
FitOutcome fit_live(const ReplayOptions& fit, capture::CameraRecording& recording,
                    std::atomic<bool>& window_closed, const CommandContext& context) {
  const LiveCamera live{[&window_closed] { window_closed = true; }};
  return fit_session(fit, capture::open_session(fit.session), recording.frames(), context, &live);
}

/// Shows a walk what its camera has recorded, until the recording has ended.
void look_on(reconstruction::LiveWalk& walk, const std::filesystem::path& session,
             capture::CameraRecording& recording, const CommandContext& context) {
  TerminalSink sink(context);
  const auto frames = recording.frames();
  int count = 0;
  while (!recording.status().has_ended && !recording.status().disk_fault) {
    const auto frame = frames->next();
    if (!frame) break;
    try {
      walk.look_at(*frame);
    } catch (const core::Error&) {  // another board in the first images: nothing is lost
      recording.stop();
      std::error_code no_throw;
      std::filesystem::remove_all(session, no_throw);
      throw;
    }
    constexpr std::size_t all = reconstruction::kViewDirections;
    sink.progress(
        {"recording", ++count, 0,
         fmt::format("{} of {} directions seen", all - walk.sight().missing.size(), all)});
  }
  recording.stop();
}

/// Looks at a walk of which something is not known while it is recorded, in a window if one is
/// wanted. Throws core::Error (bad_input) when its first images show another board.
void watch_walk(const CaptureOptions& options, const capture::SessionSetup& setup,
                capture::CameraRecording& recording, std::atomic<bool>& window_closed,
                const CommandContext& context) {
  reconstruction::LiveWalk walk({.session = options.session,
                                 .board = setup.board.empty()
                                              ? std::nullopt
                                              : std::optional(capture::read_board(setup.board)),
                                 .camera = setup.camera,
                                 .camera_is_guessed = setup.camera_is_guessed});
  const auto look = [&] { look_on(walk, options.session, recording, context); };
  if (!options.fit.preview) return look();
  const reconstruction::LiveHull hull(walk, options.session);
  const WalkModel model({.session = options.session,
                         .walk = walk,
                         .hull = [&hull] { return hull.news(); },
                         .frames = [&recording] { return recording.recorded_frames(); },
                         .options = options.fit.reconstruction});
  run_walk({.title = options.session.filename().string() + " \u2013 Sheen",
            .walk = walk,
            .hull = hull,
            .model = &model,
            .snapshot_folder = options.fit.snapshots},
           look, [&window_closed] { window_closed = true; });
}

/// Finds what is missing of a recorded walk and fits it.
FitOutcome fit_walk(ReplayOptions fit, const CommandContext& context) {
  fit.preview = false;
  try {
    return fit_recording(fit, context);
  } catch (const core::Error&) {
    context.note(fmt::format("note: the recording is kept in {}", fit.session.string()));
    throw;
  }
}

void run_capture(const CaptureOptions& options, const CommandContext& context) {
  if (options.list) return list_cameras(context);
  if (options.session.empty()) throw UsageError("--output is required");
  CaptureOptions watched = options;
  if (watched.session.extension() == ".glb") {
    if (watched.fit.output.empty()) watched.fit.output = watched.session;
    watched.session.replace_extension();
  }
  watched.fit.preview = !options.headless;
  capture::V4l2CameraOptions wish = options.camera;
  const capture::SessionSetup setup = read_setup(options);
  const bool is_near = !capture::is_network_address(wish.device.string());
  if (is_near && !wish.mode.size && !setup.camera_is_guessed) {
    wish.mode.size = capture::ImageSize{setup.camera.width_px(), setup.camera.height_px()};
  }
  capture_session(capture::open_camera(wish), watched, context);
}

}  // namespace

void capture_session(std::unique_ptr<capture::Camera> camera, const CaptureOptions& options,
                     const CommandContext& context) {
  // Start recording.
  ReplayOptions fit = options.fit;
  fit.session = options.session;
  if (fit.output.empty()) fit.output = options.session / "model.glb";
  const capture::CameraDescription description = camera->description();
  capture::SessionSetup setup = read_setup(options);
  if (setup.camera_is_guessed) {
    setup.camera = capture::plain_camera({description.width_px, description.height_px});
  }
  check_size(description, setup);
  check_before_recording(options, setup, context);
  capture::SessionRecorder recorder(options.session, setup, description.fps, description.video);
  std::optional<core::FolderLock> lock(options.session);
  const FinishOnInterrupt finishing;
  std::atomic<bool> window_closed{false};
  capture::CameraRecording recording(std::move(camera), recorder,
                                     terms_of(options, context, window_closed));

  // Fit.
  FitOutcome outcome;
  try {
    if (is_complete(setup)) {
      outcome = fit_live(fit, recording, window_closed, context);
    } else {
      watch_walk(options, setup, recording, window_closed, context);
      lock.reset();  // whoever finds what is missing writes into the session
      outcome = fit_walk(fit, context);
    }
  } catch (const core::Error&) {
    recording.stop();
    if (const auto fault = recording.status().camera_fault) throw core::Error(*fault);
    throw;
  }
  const capture::RecordingStatus status = recording.status();
  outcome.document["recording"] = to_json(options, status);
  context.publish(outcome.document, to_text(options, status) + outcome.text);
  if (status.camera_fault) throw core::Error(*status.camera_fault);
  if (status.disk_fault) throw core::Error(*status.disk_fault);
}

void add_capture_command(CommandLine& program, CommandContext& context) {
  auto options = std::make_shared<CaptureOptions>();
  Command command =
      program.command("capture", "Record an object live and turn it into a light field");
  command.example(
      "Examples: an object on the sheet of sheen board, walk round it until the window is closed;\n"
      "camera and mesh are found from the walk, then the light field:\n"
      "  sheen capture /dev/video0 -o knot.glb\n"
      "With what is known, here that of an earlier session, it grows while you walk:\n"
      "  sheen capture /dev/video0 -o knot --like sample_data/glossy\n"
      "A phone whose app serves its camera as MJPEG, until Ctrl-C:\n"
      "  sheen capture http://192.168.1.20:8080/video -o knot.glb --headless\n"
      "A camera that sends H.264 by RTSP:\n"
      "  sheen capture rtsp://USER:PASSWORD@192.168.1.21/stream1 -o knot.glb");
  add_capture_options(command, *options);
  add_common_options(command, context);
  command.action([options, &context] { run_capture(*options, context); });
}

}  // namespace sheen::app
