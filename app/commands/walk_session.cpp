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

/// Takes over a file that the session lacks.
void take(const std::filesystem::path& file, const std::filesystem::path& folder,
          const char* option, std::optional<std::filesystem::path>& place, const char* name) {
  if (file.empty()) return;
  if (place) {
    throw core::bad_input(*place, fmt::format("is the session's already, {} is not needed", option),
                          "leave the option away, or replace that file");
  }
  std::error_code no_throw;
  if (std::filesystem::exists(folder / name, no_throw)) {
    throw core::bad_input(folder / name, "is there, though session.json does not name it",
                          "name it there or take it away");
  }
  capture::copy_into_session(file, folder / name);
  place = folder / name;
}

std::optional<std::string> name_if(bool is_new, const char* name) {
  return is_new ? std::optional<std::string>(name) : std::nullopt;
}

void find_what_lacks(const capture::Session& session, const pipeline::FrameChoice& choice,
                     pipeline::ProgressSink& sink, WalkAnswer& answer) {
  const pipeline::WalkFindings found = pipeline::read_walk(session, choice, sink);
  if (found.sheet) {
    capture::write_board(session.folder / "board.yaml", found.board);
    answer.document["sheet"] = found.sheet->paper;
    answer.text += fmt::format("board    the sheet of sheen board, {} paper\n", found.sheet->paper);
  }
  if (found.calibration) {
    capture::write_camera(session.folder / "camera.yaml", found.calibration->camera);
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
  if (!options.camera.empty()) static_cast<void>(capture::read_camera(options.camera));
  if (!options.board.empty()) static_cast<void>(capture::read_board(options.board));
  std::optional<SessionLock> lock;
  if (lacks_camera || lacks_board)
    lock.emplace(folder, std::initializer_list<std::filesystem::path>{folder / "session.json"});
  take(options.camera, folder, "--camera", session.camera_file, "camera.yaml");
  take(options.board, folder, "--board", session.board, "board.yaml");
  if (!lacks_camera && !lacks_board) return session;

  // Find the rest, then name it all at once.
  if (!session.camera_file || (lacks_board && !session.board)) {
    find_what_lacks(session, choice, sink, answer);
  }
  capture::write_camera_and_board(folder / "session.json", name_if(lacks_camera, "camera.yaml"),
                                  name_if(lacks_board, "board.yaml"));
  return capture::open_session(folder);
}

}  // namespace sheen::app
