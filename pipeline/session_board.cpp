// SPDX-License-Identifier: MIT
#include "pipeline/session_board.h"

#include "capture/pose/board_tags.h"
#include "core/diagnostics/error.h"

namespace sheen::pipeline {
namespace {

constexpr std::size_t kMostViews = 240;

/// Keeps every second view: the recording is longer than needed.
void thin_out(std::vector<std::vector<capture::TagDetection>>& views) {
  for (std::size_t i = 0; 2 * i < views.size(); ++i) views[i] = std::move(views[2 * i]);
  views.resize((views.size() + 1) / 2);
}

}  // namespace

std::optional<capture::BoardRefinement> refine_session_board(const capture::Session& session,
                                                             int start, std::optional<int> end,
                                                             ProgressSink& sink,
                                                             capture::LensRefinement lens) {
  if (!session.board) {
    throw core::bad_input(session.folder / "session.json", "has no board to refine",
                          "name a board.yaml under \"board\"");
  }
  const capture::Board board = capture::read_board(*session.board);
  capture::BoardTagFinder finder(board, session.camera);
  const auto frames = capture::open_frames(session, start, end);
  std::vector<std::vector<capture::TagDetection>> views;
  int stride = 1;
  for (int i = 0; const auto frame = frames->next(); ++i) {
    sink.progress({"refining the board", i + 1});
    if (i % stride != 0) continue;
    finder.look_at(*frame);
    views.push_back(finder.find());
    if (views.size() < kMostViews) continue;
    thin_out(views);
    stride *= 2;
  }
  return capture::refine_board(board, session.camera, views, lens);
}

}  // namespace sheen::pipeline
