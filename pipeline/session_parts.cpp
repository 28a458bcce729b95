// SPDX-License-Identifier: MIT
#include "pipeline/session_parts.h"

#include "core/diagnostics/error.h"

namespace sheen::pipeline {
namespace {

constexpr double kFallbackFps = 30;

}  // namespace

bool takes_poses_from_file(const capture::Session& session, PoseSource source) {
  return source == PoseSource::file || (source == PoseSource::automatic && session.poses);
}

std::optional<capture::Board> tag_board(const capture::Session& session, PoseSource source) {
  if (takes_poses_from_file(session, source) || !session.board) return std::nullopt;
  return capture::read_board(*session.board);
}

std::unique_ptr<capture::PoseEstimator> make_pose_estimator(const capture::Session& session,
                                                            PoseSource source,
                                                            const capture::PoseGate& gate,
                                                            const capture::Board* board) {
  const auto session_file = session.folder / "session.json";
  if (takes_poses_from_file(session, source)) {
    if (!session.poses) {
      throw core::bad_input(session_file, "has no poses",
                            "name a poses.txt under \"poses\" or take the poses from the tags");
    }
    return capture::make_recorded_pose_estimator(capture::read_trajectory(*session.poses),
                                                 session.fps.value_or(kFallbackFps),
                                                 session.camera.intrinsics().readout_s);
  }
  if (!session.board) {
    throw core::bad_input(session_file, "has no board",
                          "name a board.yaml under \"board\" or take the poses from a file");
  }
  return capture::make_tag_pose_estimator(
      board != nullptr ? *board : capture::read_board(*session.board), session.camera, gate);
}

}  // namespace sheen::pipeline
