// SPDX-License-Identifier: MIT
#include "app/commands/walk_session.h"

#include "app/session_lock.h"
#include "capture/calibration/camera_file.h"
#include "capture/session/new_session.h"
#include "capture/session/session_file.h"
#include "core/diagnostics/error.h"
#include "pipeline/session_camera.h"

#include <fmt/format.h>

namespace sheen::app {
namespace {

using capture::WalkCalibration;

/// Digits for what is known of it.
std::string number_text(const WalkCalibration::Number& number) {
  const int digits = number.name == "focal" || number.name == "cx" || number.name == "cy" ? 1 : 4;
  return fmt::format("{} {:.{}f} +- {:.{}f}", number.name, number.value, digits, number.sigma,
                     digits);
}

std::string describe(const WalkCalibration& found) {
  std::vector<std::string> kept;
  std::vector<std::string> left;
  for (const WalkCalibration::Number& number : found.numbers) {
    if (number.is_kept) {
      kept.push_back(number_text(number));
    } else {
      left.emplace_back(number.name);
    }
  }
  std::string text = fmt::format("camera   {}\n         {:.2f} px RMS over {} views",
                                 fmt::join(kept, ", "), found.rms_px, found.views);
  if (!left.empty()) {
    text += fmt::format("; not told from the usual and left there: {}", fmt::join(left, " "));
  }
  return text + fmt::format(
                    "\nscale    heights above the sheet are uncertain by {:.2f} %, the camera's "
                    "distance by {:.2f} %\n",
                    100 * found.height_sigma, 100 * found.distance_sigma);
}

nlohmann::ordered_json to_json(const WalkCalibration& found) {
  nlohmann::ordered_json numbers = nlohmann::ordered_json::array();
  for (const WalkCalibration::Number& number : found.numbers) {
    numbers.push_back({{"name", number.name},
                       {"value", number.value},
                       {"sigma", number.sigma},
                       {"prior", number.prior},
                       {"kept", number.is_kept}});
  }
  return {{"numbers", numbers},
          {"height_sigma", found.height_sigma},
          {"distance_sigma", found.distance_sigma},
          {"rms_px", found.rms_px},
          {"views", found.views}};
}

/// Lets the session read a file that is given. Throws core::Error (bad_input) where it has one.
void take(const std::filesystem::path& file, const char* option,
          std::optional<std::filesystem::path>& place) {
  if (file.empty()) return;
  if (place) {
    throw core::bad_input(*place, fmt::format("is the session's already, {} is not needed", option),
                          "leave the option away, or replace that file");
  }
  place = file;
}

/// What is about to be written must not replace somebody's file.
void require_room(const std::filesystem::path& file) {
  std::error_code no_throw;
  if (!std::filesystem::exists(file, no_throw)) return;
  throw core::bad_input(file, "is there, though session.json does not name it",
                        "name it there or take it away");
}

std::optional<std::string> name_if(bool is_new, const char* name) {
  return is_new ? std::optional<std::string>(name) : std::nullopt;
}

void tell(const pipeline::WalkFindings& found, WalkAnswer& answer) {
  if (found.sheet) {
    answer.document["sheet"] = found.sheet->paper;
    answer.text += fmt::format("board    the sheet of sheen board, {} paper\n", found.sheet->paper);
  }
  if (found.calibration) {
    answer.document["camera"] = to_json(*found.calibration);
    answer.text += describe(*found.calibration);
  }
}

}  // namespace

void add_walk_options(Command command, WalkOptions& options) {
  command
      .option("--camera", options.camera,
              "Camera file for a recording that has none (default: found from its tags)")
      .type("FILE");
  command
      .option("--board", options.board,
              "board.yaml for a recording that has none (default: the sheet of sheen board)")
      .type("FILE");
}

capture::Session open_walk(const std::filesystem::path& folder, const WalkOptions& options,
                           const pipeline::FrameChoice& choice, pipeline::ProgressSink& sink,
                           WalkAnswer& answer) {
  // Take what is given.
  capture::Session session = capture::open_unfinished_session(folder);
  const bool lacks_camera = !session.camera_file;
  const bool lacks_board = !session.board && (!session.poses || lacks_camera);
  take(options.camera, "--camera", session.camera_file);
  take(options.board, "--board", session.board);
  if (!lacks_camera && !lacks_board) return session;
  const std::filesystem::path camera_file = folder / "camera.yaml";
  const std::filesystem::path board_file = folder / "board.yaml";
  const SessionLock lock(folder, {folder / "session.json"});
  if (lacks_camera) require_room(camera_file);
  if (lacks_board) require_room(board_file);

  // Find the rest, then write all of it and name it: a walk that does not tell changes nothing.
  const core::CameraModel given_camera =
      options.camera.empty() ? session.camera : capture::read_camera(options.camera);
  std::optional<pipeline::WalkFindings> found;
  if (!session.camera_file || (lacks_board && !session.board)) {
    found = pipeline::read_walk(session, choice, sink);
    tell(*found, answer);
  }
  if (lacks_board) {
    capture::write_board(board_file, found ? found->board : capture::read_board(*session.board));
  }
  if (lacks_camera) {
    capture::write_camera(camera_file,
                          found && found->calibration ? found->calibration->camera : given_camera);
  }
  capture::write_camera_and_board(folder / "session.json", name_if(lacks_camera, "camera.yaml"),
                                  name_if(lacks_board, "board.yaml"));
  return capture::open_session(folder);
}

}  // namespace sheen::app
