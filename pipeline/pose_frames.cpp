// SPDX-License-Identifier: MIT
#include "pipeline/pose_frames.h"

#include "core/diagnostics/error.h"
#include "pipeline/hold_out.h"
#include "pipeline/session_parts.h"

#include <fmt/format.h>

namespace sheen::pipeline {

std::vector<PosedFrame> pose_frames(const capture::Session& session, const FrameChoice& choice,
                                    ProgressSink& sink) {
  const auto frames = capture::open_frames(session, choice.start, choice.end);
  const auto poses = make_pose_estimator(session, choice.pose_source, choice.gate);
  const HoldOut hold_out{choice.hold_out};
  std::vector<PosedFrame> posed;
  int frames_read = 0;
  while (const auto frame = frames->next()) {
    sink.progress({"posing", ++frames_read});
    if (choice.hold_out > 0 && !hold_out.contains(frame->index)) continue;
    const auto result = poses->estimate(*frame);
    if (const auto* pose = std::get_if<capture::FramePose>(&result)) {
      posed.push_back({frame->index, frame->time_s, pose->camera_from_board});
    }
  }
  if (posed.empty()) {
    throw core::bad_input(session.folder, fmt::format("none of {} frames got a pose", frames_read),
                          "sheen replay tells why frames are refused");
  }
  return posed;
}

}  // namespace sheen::pipeline
