// SPDX-License-Identifier: MIT
#include "pipeline/session_board.h"

#include "capture/pose/board_tags.h"
#include "core/diagnostics/error.h"
#include "pipeline/evidence/tag_evidence.h"
#include "pipeline/thinned.h"

namespace sheen::pipeline {
namespace {

constexpr std::size_t kMostBoardViews = 240;

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
  TagEvidence tags(board, session.camera);
  Thinned<std::vector<capture::TagDetection>> views(kMostBoardViews);
  for (int i = 0; const auto frame = frames->next(); ++i) {
    sink.progress({"refining the board", i + 1});
    tags.look_at(*frame);
    if (!views.is_due()) continue;
    finder.look_at(*frame);
    views.add(finder.find());
  }
  tags.refuse_shifted(*session.board);
  return capture::refine_board(board, session.camera, views.items(), lens);
}

}  // namespace sheen::pipeline
