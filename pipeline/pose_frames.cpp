// SPDX-License-Identifier: MIT
#include "pipeline/pose_frames.h"

#include "pipeline/check_seen.h"
#include "pipeline/evidence/tag_evidence.h"
#include "pipeline/hold_out.h"
#include "pipeline/pose_stage.h"
#include "pipeline/session_parts.h"

#include <fmt/format.h>

#include <optional>

namespace sheen::pipeline {
namespace {

/// Where poses come from tags.
std::optional<TagEvidence> tag_evidence(const capture::Session& session, PoseSource source) {
  if (!session.board || takes_poses_from_file(session, source)) return std::nullopt;
  return TagEvidence(capture::read_board(*session.board), session.camera);
}

}  // namespace

std::vector<PosedFrame> pose_frames(const capture::Session& session, const FrameChoice& choice,
                                    ProgressSink& sink) {
  PoseStage poses(capture::open_frames(session, choice.start, choice.end),
                  make_pose_estimator(session, choice.pose_source, choice.gate));
  check_stamps(session, choice, poses.frame_count());
  const HoldOut hold_out{choice.hold_out};
  auto tags = tag_evidence(session, choice.pose_source);
  FrameStatistics statistics;
  std::vector<PosedFrame> posed;
  int frames_read = 0;
  while (const auto tracked = poses.next([&](const capture::Frame& frame) {
    sink.progress({"posing", ++frames_read});
    if (tags) tags->look_at(frame);
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
  if (tags) tags->refuse_shifted(*session.board);
  return posed;
}

}  // namespace sheen::pipeline
