// SPDX-License-Identifier: MIT
#include "pipeline/check_seen.h"

#include "capture/pose/board_diagnosis.h"
#include "capture/pose/pose_convention.h"
#include "capture/pose/stamp_check.h"
#include "capture/source/image_folder_source.h"
#include "core/diagnostics/error.h"
#include "pipeline/session_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

namespace sheen::pipeline {
namespace {

constexpr int kDiagnosedFrames = 8;
constexpr int kDiagnosedSpan = 240;

std::string reasons_text(const FrameStatistics& frames) {
  std::string reasons;
  for (const auto& [reason, count] : frames.pose_rejections) {
    reasons += fmt::format("{}{} {}", reasons.empty() ? "" : ", ", count, reason);
  }
  return reasons;
}

capture::PoseRejection most_frequent(const FrameStatistics& frames) {
  using capture::PoseRejection;
  constexpr std::array all{PoseRejection::no_tags, PoseRejection::too_few_tags,
                           PoseRejection::reprojection, PoseRejection::blur};
  return *std::max_element(all.begin(), all.end(), [&](PoseRejection a, PoseRejection b) {
    const auto count = [&](PoseRejection rejection) {
      const auto found = frames.pose_rejections.find(std::string(name_of(rejection)));
      return found == frames.pose_rejections.end() ? 0 : found->second;
    };
    return count(a) < count(b);
  });
}

capture::FrameSpan span_of(const FrameStatistics& frames) {
  return {.count = frames.frames_read,
          .first_index = frames.first_index,
          .last_index = frames.last_index,
          .first_s = frames.first_s,
          .last_s = frames.last_s};
}

/// Poses from a file that most frames do not find there, because its stamps count frames or are of
/// another unit.
void refuse_other_stamps(const capture::Session& session, const FrameStatistics& frames) {
  if (2 * static_cast<int>(frames.posed.size()) > frames.frames_read) return;
  const capture::Trajectory poses = capture::read_trajectory(*session.poses);
  auto fault = capture::counting_stamps(poses, span_of(frames));
  if (!fault) fault = capture::finer_stamps(poses, span_of(frames));
  if (!fault) return;
  throw core::bad_input(*session.poses,
                        fmt::format("gives {} of {} frames a pose: {}", frames.posed.size(),
                                    frames.frames_read, fault->fault),
                        fault->remedy);
}

[[noreturn]] void refuse_by_stamps(const capture::Session& session, const FrameStatistics& frames) {
  const auto stamps =
      capture::unmatched_stamps(capture::read_trajectory(*session.poses), span_of(frames));
  throw core::bad_input(
      *session.poses,
      fmt::format("gives none of {} frames a pose: {}", frames.frames_read, stamps.fault),
      stamps.remedy);
}

[[noreturn]] void refuse_by_tags(const capture::Session& session, const FrameChoice& choice,
                                 const FrameStatistics& frames) {
  capture::BoardDiagnosis diagnosis(capture::read_board(*session.board), session.camera);
  const auto source = capture::open_frames(session, choice.start, choice.end);
  const int stride = std::max(1, std::min(frames.frames_read, kDiagnosedSpan) / kDiagnosedFrames);
  for (int i = 0; i < kDiagnosedSpan; ++i) {
    const auto frame = source->next();
    if (!frame) break;
    if (i % stride == 0) diagnosis.look_at(*frame);
  }
  const capture::PoseCause cause = diagnosis.cause(most_frequent(frames));
  const auto camera = session.camera_file.value_or(session.folder / "camera.yaml");
  const auto& subject = cause.suspect == capture::PoseSuspect::board    ? *session.board
                        : cause.suspect == capture::PoseSuspect::camera ? camera
                                                                        : session.folder;
  // What is known of the recording itself, such as interlaced images or the shape of its pixels,
  // may be the cause.
  const auto notes = source->report().notes;
  const bool is_settled = cause.is_sure && cause.suspect != capture::PoseSuspect::camera;
  const std::string doubt = is_settled || notes.empty() ? "" : notes.front() + "; ";
  throw core::bad_input(subject,
                        fmt::format("{}; none of {} frames got a pose ({})", cause.fault,
                                    frames.frames_read, reasons_text(frames)),
                        doubt + cause.remedy);
}

/// Whether the poses of a file are of another convention: the file is at fault then, not the mesh.
void refuse_other_convention(const capture::Session& session, const FrameStatistics& frames,
                             const SessionScene& scene) {
  std::vector<Eigen::Isometry3d> poses;
  for (const PosedFrame& posed : frames.posed) poses.push_back(posed.camera_from_board);
  const auto convention = capture::other_convention(poses, session.camera, scene.object_in_board());
  if (!convention) return;
  throw core::bad_input(*session.poses, "shows the object in few frames; " + convention->fault,
                        convention->remedy);
}

/// Poses come from a file, and all of the recording was asked for.
bool has_stamps_for_all(const capture::Session& session, const FrameChoice& choice) {
  return takes_poses_from_file(session, choice.pose_source) && session.poses && choice.start == 0 &&
         !choice.end;
}

/// Number in the name of the recording's first image; 0 for a video.
int first_image_number(const capture::Session& session) {
  const auto name = capture::NumberedName::parse(session.image_pattern.value_or(""));
  return name ? capture::find_images(session.folder, *name).first : 0;
}

/// Why the vertices of the mesh gave no sample, by the reason that most of them have.
core::Error unseen(const capture::Session& session, const FrameStatistics& frames,
                   const SessionScene& scene) {
  const auto most = static_cast<core::VertexRejection>(
      std::max_element(frames.vertex_rejections.begin() + 1, frames.vertex_rejections.end()) -
      frames.vertex_rejections.begin());
  const std::string fault = "is not seen in any posed frame: ";
  switch (most) {
    case core::VertexRejection::back_facing:
    case core::VertexRejection::grazing:
      return core::bad_input(session.mesh, fault + "it shows the cameras its back",
                             "turn its triangles and normals, or check T_stage_object");
    case core::VertexRejection::occluded:
      return core::bad_input(session.mesh, fault + "all of it is hidden by itself",
                             "check that the surface is not within another");
    default:
      return core::bad_input(session.mesh,
                             fault + "it lies outside of the images; " + scene.description(),
                             takes_poses_from_file(session, PoseSource::automatic)
                                 ? "check T_stage_object, and that mesh and poses are in metres"
                                 : "check T_stage_object, and that mesh and board are in metres");
  }
}

}  // namespace

void check_something_was_posed(const capture::Session& session, const FrameChoice& choice,
                               const FrameStatistics& frames) {
  if (!frames.posed.empty()) return;
  if (frames.frames_read == 0) {
    throw core::bad_input(session.folder, "holds no frame that can be read",
                          "check the recording, all of its images are damaged");
  }
  if (takes_poses_from_file(session, choice.pose_source) && session.poses) {
    refuse_by_stamps(session, frames);
  }
  refuse_by_tags(session, choice, frames);
}

void check_something_was_seen(const capture::Session& session, const FrameChoice& choice,
                              const FrameStatistics& frames, bool patches_were_seen,
                              const SessionScene& scene) {
  check_something_was_posed(session, choice, frames);
  const bool has_file = takes_poses_from_file(session, choice.pose_source) && session.poses;
  if (has_file) refuse_other_stamps(session, frames);
  if (has_file) refuse_other_convention(session, frames, scene);
  if (!patches_were_seen && frames.frames_fitted + frames.frames_refused > 0) {
    throw unseen(session, frames, scene);
  }
  if (!patches_were_seen) {
    throw core::bad_input(session.mesh, "is not seen in any posed frame",
                          "check T_stage_object and that mesh and board are in metres");
  }
}

void check_stamps(const capture::Session& session, const FrameChoice& choice,
                  std::optional<int> frame_count) {
  if (!has_stamps_for_all(session, choice) || !frame_count) return;
  const auto fault =
      capture::shifted_stamps(capture::read_trajectory(*session.poses), *frame_count);
  if (fault) throw core::bad_input(*session.poses, fault->fault, fault->remedy);
}

std::vector<std::string> doubts_of_stamps(const capture::Session& session,
                                          const FrameChoice& choice,
                                          const FrameStatistics& frames) {
  if (!has_stamps_for_all(session, choice)) return {};
  const capture::Trajectory poses = capture::read_trajectory(*session.poses);
  const capture::FrameSpan span = span_of(frames);
  std::vector<std::string> doubts;
  for (const auto& doubt : {capture::miscounting_stamps(poses, span, first_image_number(session)),
                            capture::stamps_outside(poses, span)}) {
    if (!doubt) continue;
    doubts.push_back(
        fmt::format("{}: {}; {}", session.poses->string(), doubt->fault, doubt->remedy));
  }
  return doubts;
}

}  // namespace sheen::pipeline
