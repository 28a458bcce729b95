// SPDX-License-Identifier: MIT
#include "pipeline/pose_frames.h"

#include "pipeline/check_seen.h"
#include "pipeline/hold_out.h"
#include "pipeline/pose_stage.h"
#include "pipeline/session_parts.h"

#include <fmt/format.h>

namespace sheen::pipeline {

std::vector<PosedFrame> pose_frames(const capture::Session& session, const FrameChoice& choice,
                                    ProgressSink& sink) {
  PoseStage poses(capture::open_frames(session, choice.start, choice.end),
                  make_pose_estimator(session, choice.pose_source, choice.gate));
  check_stamps(session, choice, poses.frame_count());
  const HoldOut hold_out{choice.hold_out};
  FrameStatistics statistics;
  std::vector<PosedFrame> posed;
  int frames_read = 0;
  while (const auto tracked = poses.next([&](const capture::Frame& frame) {
    sink.progress({"posing", ++frames_read});
    return choice.hold_out == 0 || hold_out.contains(frame.index);
  })) {
    if (const auto view = statistics.count(*tracked)) posed.push_back(*view);
  }
  const capture::SourceReport recording = poses.report();
  for (const std::string& note : recording.notes) sink.note(note);
  if (recording.damaged > 0) {
    sink.note(fmt::format("{}: {} damaged frames were left out", session.folder.string(),
                          recording.damaged));
  }
  statistics.posed = posed;
  check_something_was_posed(session, choice, statistics);
  return posed;
}

}  // namespace sheen::pipeline
