// SPDX-License-Identifier: MIT
#include "pipeline/session_mesh.h"

#include "capture/plausibility/unit_guess.h"
#include "core/diagnostics/error.h"
#include "core/mesh/bounds.h"
#include "core/mesh/parts.h"
#include "core/mesh/read_mesh.h"
#include "core/mesh/repair.h"
#include "core/mesh/winding.h"
#include "pipeline/session_parts.h"

#include <fmt/format.h>

#include <algorithm>

namespace sheen::pipeline {
namespace {

constexpr double kLargestObject_m = 20.0;
constexpr double kSmallestObject_m = 0.001;
constexpr int kSideFrames = 120;          // at the start of a recording
constexpr std::size_t kProbes = 12;       // poses that decide which side is outside
constexpr std::size_t kEnoughViews = 30;  // to refuse before the recording is over
constexpr double kDoubtfulBack = 0.25;    // of what cameras see

void tell(ProgressSink& sink, const std::filesystem::path& file, const std::string& note) {
  sink.note(file.string() + ": " + note);
}

/// At most `most` of them, spread evenly.
std::vector<Eigen::Isometry3d> spread(std::span<const Eigen::Isometry3d> poses, std::size_t most) {
  std::vector<Eigen::Isometry3d> chosen;
  const std::size_t count = std::min(most, poses.size());
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(poses[i * poses.size() / count]);
  return chosen;
}

}  // namespace

core::Mesh read_object_mesh(const std::filesystem::path& path, std::vector<std::string>* notes) {
  core::Mesh mesh = core::read_mesh(path, notes);
  const double size_m = core::bounds_of(mesh).diagonal().cast<double>().norm();
  if (size_m > kLargestObject_m || size_m < kSmallestObject_m) {
    throw core::bad_input(path,
                          fmt::format("is {:.4g} m across, its unit must be the metre", size_m),
                          capture::unit_question(size_m, 0.02, 3, "scale it to its true size"));
  }
  return mesh;
}

core::Mesh read_session_mesh(capture::Session& session, ProgressSink& sink) {
  if (session.mesh.empty()) {
    throw core::bad_input(session.folder, "has no mesh of its object yet",
                          "make one: sheen mesh " + session.folder.string());
  }
  std::vector<std::string> notes;
  core::Mesh mesh = read_object_mesh(session.mesh, &notes);
  for (const std::string& note : notes) tell(sink, session.mesh, note);
  session.take_offset(mesh.offset);
  return mesh;
}

bool needs_cameras(const core::Mesh& mesh) {
  return !core::is_closed(mesh) || core::mesh_parts(mesh).count > 1;
}

void face_cameras(core::Mesh& mesh, const capture::Session& session,
                  std::span<const Eigen::Isometry3d> camera_from_board, ProgressSink& sink) {
  if (camera_from_board.empty() || !needs_cameras(mesh)) return;
  std::vector<core::MeshView> views;
  for (const Eigen::Isometry3d& pose : spread(camera_from_board, kProbes)) {
    views.push_back({&session.camera, pose * session.board_from_object});
  }
  const core::SeenSides seen = core::face_cameras(mesh, views);
  if (seen.turned_parts > 0) {
    tell(sink, session.mesh,
         fmt::format("is inside out, the cameras see {:.0f} % of it from behind; {} of its parts "
                     "turned",
                     100 * seen.back_share, seen.turned_parts));
  } else if (seen.back_share > kDoubtfulBack) {
    tell(sink, session.mesh,
         fmt::format("the cameras see {:.0f} % of it from behind, where it shows nothing; is it "
                     "inside out in parts, or open towards them?",
                     100 * seen.back_share));
  }
  if (seen.turned_normals) {
    tell(sink, session.mesh, "its normals point away from the cameras and were turned");
  }
}

std::vector<Eigen::Isometry3d> probe_poses(const capture::Session& session,
                                           const FrameChoice& choice) {
  std::vector<Eigen::Isometry3d> poses;
  if (takes_poses_from_file(session, choice.pose_source) && session.poses) {
    const capture::Trajectory trajectory = capture::read_trajectory(*session.poses);
    for (const auto& entry : trajectory.entries()) {
      poses.push_back(entry.board_from_camera.inverse());
    }
    return spread(poses, kProbes);
  }
  const auto estimator = make_pose_estimator(session, choice.pose_source, choice.gate);
  const auto frames = capture::open_frames(session, choice.start, choice.end);
  const int stride = kSideFrames / static_cast<int>(kProbes);
  for (int i = 0; i < kSideFrames && poses.size() < kProbes; ++i) {
    const auto frame = frames->next();
    if (!frame) break;
    // Frames in between are passed over once one is posed; until then each is tried.
    if (i % stride != 0 && !poses.empty()) continue;
    const auto result = estimator->estimate(*frame);
    if (const auto* pose = std::get_if<capture::FramePose>(&result)) {
      poses.push_back(pose->camera_from_board);
    }
  }
  return poses;
}

SessionScene::SessionScene(const capture::Session& session, const core::Mesh& mesh,
                           PoseSource source, ProgressSink& sink)
    : object_in_board_(session.board_from_object * core::bounds_of(mesh).center().cast<double>()) {
  if (!takes_poses_from_file(session, source) && session.board) {
    board_ = capture::read_board(*session.board);
  }
  check_ = std::make_unique<capture::SceneCheck>(session, mesh, board_ ? &*board_ : nullptr);
  for (const std::string& doubt : check_->check_sizes()) sink.note(doubt);
}

void SessionScene::see(const Eigen::Isometry3d& camera_from_board) {
  check_->see(camera_from_board);
  if (check_->views() == kEnoughViews) check_->check_views();
}

void SessionScene::finish(ProgressSink& sink) const {
  check_->check_views();
  for (const std::string& doubt : check_->doubts()) sink.note(doubt);
}

void SessionScene::check(const capture::Session& session, const core::Mesh& mesh, PoseSource source,
                         const std::vector<PosedFrame>& views, ProgressSink& sink) {
  SessionScene scene(session, mesh, source, sink);
  for (const PosedFrame& view : views) scene.see(view.camera_from_board);
  scene.finish(sink);
}

}  // namespace sheen::pipeline
