// SPDX-License-Identifier: MIT
#include "pipeline/posed_views.h"

#include "pipeline/frame_corrections.h"

namespace sheen::pipeline {

void for_each_view(const capture::Session& session, const core::Mesh* mesh,
                   const std::vector<PosedFrame>& views,
                   const std::function<void(const capture::Frame&,
                                            const Eigen::Isometry3d& camera_from_object)>& visit) {
  if (views.empty()) return;
  const auto frames = capture::open_frames(session, views.front().index, views.back().index + 1);
  FrameCorrections corrections(session, mesh, 1);
  auto view = views.begin();
  while (view != views.end()) {
    const auto frame = frames->next();
    if (!frame) break;
    if (frame->index != view->index) continue;
    visit(corrections.correct(*frame, view->camera_from_board, view->readout_motion),
          view->camera_from_board * session.board_from_object);
    ++view;
  }
}

}  // namespace sheen::pipeline
