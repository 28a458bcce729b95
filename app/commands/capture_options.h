// SPDX-License-Identifier: MIT
#pragma once

#include "app/commands/replay_options.h"
#include "capture/session/session_recorder.h"
#include "capture/source/v4l2_camera.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace sheen::app {

/// Everything `sheen capture` may be asked.
struct CaptureOptions {
  capture::V4l2CameraOptions camera;
  std::filesystem::path session;  ///< to be recorded
  std::filesystem::path like;     ///< session whose camera, board and object are taken over
  std::filesystem::path camera_file, board, mesh;  ///< each replaces what `like` has; may be empty
  std::vector<double> board_from_object;           ///< 16 numbers by rows, or none
  std::optional<int> frames;                       ///< record no more images
  std::optional<double> seconds;                   ///< record no longer
  bool headless = false;                           ///< without a window
  bool list = false;                               ///< only list the cameras
  ReplayOptions fit;                               ///< what becomes of the frames
};

void add_capture_options(Command command, CaptureOptions& options);

/// What the recording will say besides its frames, as given or as in `like`. Without a camera file
/// `camera` is of no size. Throws core::Error (bad_input).
capture::SessionSetup read_setup(const CaptureOptions& options);

}  // namespace sheen::app
