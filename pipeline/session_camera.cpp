// SPDX-License-Identifier: MIT
#include "pipeline/session_camera.h"

#include "capture/pose/board_tags.h"
#include "capture/source/image_folder_source.h"
#include "capture/source/video_source.h"
#include "core/diagnostics/error.h"
#include "pipeline/thinned.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace sheen::pipeline {
namespace {

constexpr std::size_t kMostWalkViews = 160;
constexpr int kRecogniseFrames = 20;  // where only the board is asked for

using Tags = std::vector<capture::TagDetection>;

struct SeenTags {
  Thinned<Tags> views{kMostWalkViews};
  int frames = 0;
  int frames_with_two = 0;  ///< of those looked at
};

SeenTags read_tags(const capture::Session& session, const capture::Board& board,
                   const FrameChoice& choice, ProgressSink& sink) {
  capture::BoardTagFinder finder(board, session.camera);
  const auto frames = capture::open_frames(session, choice.start, choice.end);
  SeenTags seen;
  while (const auto frame = frames->next()) {
    sink.progress({"finding tags", seen.frames + 1, frames->frame_count().value_or(0)});
    ++seen.frames;
    if (!seen.views.is_due()) continue;
    finder.look_at(*frame);
    Tags tags = finder.find();
    if (tags.empty() && seen.frames == 1 && !session.board) {
      capture::refuse_other_board(session.folder, session.camera, *frame);
    }
    seen.frames_with_two += tags.size() >= 2 ? 1 : 0;
    seen.views.add(std::move(tags));
    if (session.camera_file && seen.frames_with_two >= kRecogniseFrames) break;
  }
  return seen;
}

/// Fewer say nothing; the cause may be the board's.
void require_tags(const capture::Session& session, const SeenTags& seen) {
  const int fewest = session.camera_file ? 1 : static_cast<int>(capture::kFewestWalkViews);
  if (seen.frames_with_two >= fewest) return;
  throw core::bad_input(
      session.folder,
      fmt::format("{} of its {} images show two tags of {} or more, {} are needed to {}",
                  seen.frames_with_two, seen.frames,
                  session.board ? "the board" : "the sheet of sheen board", fewest,
                  session.camera_file ? "recognise it" : "find the camera"),
      session.board ? "keep the board in view, sharp and lit"
                    : "keep the sheet in view, sharp and lit; another board: --board board.yaml");
}

capture::LensPrior prior_of(const capture::Session& session) {
  const capture::ImageSize size{session.camera.width_px(), session.camera.height_px()};
  if (session.video) {
    return capture::guessed_lens(size, capture::video_pixel_aspect(*session.video));
  }
  const auto name = capture::NumberedName::parse(*session.image_pattern);
  for (const int number : {0, 1}) {
    const auto picture = session.folder / name->at(number);
    std::error_code no_throw;
    if (std::filesystem::exists(picture, no_throw)) return capture::lens_of_picture(picture, size);
  }
  return capture::guessed_lens(size);
}

capture::WalkCalibration calibrate(const capture::Session& session, const capture::Board& board,
                                   const SeenTags& seen) {
  const auto found = capture::calibrate_from_walk(board, prior_of(session), seen.views.items());
  const std::string fault =
      found ? capture::find_fault(*found) : "no lens explains where the tags are seen";
  if (fault.empty()) return *found;
  throw core::bad_input(session.folder, "the walk does not tell its camera: " + fault,
                        "film the sheet obliquely from all sides, zoom and focus locked; or give "
                        "the camera's file: --camera camera.yaml");
}

}  // namespace

WalkFindings read_walk(const capture::Session& session, const FrameChoice& choice,
                       ProgressSink& sink) {
  WalkFindings findings;
  findings.board =
      session.board ? capture::read_board(*session.board) : capture::all_default_tags();
  const SeenTags seen = read_tags(session, findings.board, choice, sink);
  findings.frames_read = seen.frames;
  require_tags(session, seen);
  if (!session.board) {
    Tags all;
    for (const Tags& tags : seen.views.items()) all.insert(all.end(), tags.begin(), tags.end());
    findings.sheet = capture::recognise_default_sheet(all);
    findings.board = capture::default_board(findings.sheet.value());
  }
  if (!session.camera_file) findings.calibration = calibrate(session, findings.board, seen);
  return findings;
}

}  // namespace sheen::pipeline
