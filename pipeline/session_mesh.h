// SPDX-License-Identifier: MIT
#pragma once

#include "capture/plausibility/scene_check.h"
#include "capture/session/session.h"
#include "core/mesh/mesh.h"
#include "pipeline/frame_statistics.h"
#include "pipeline/options.h"
#include "pipeline/progress_sink.h"

#include <Eigen/Geometry>

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace sheen::pipeline {

/// A mesh, checked to be of a size that a handheld camera can walk round: throws core::Error
/// (bad_input) for meshes in millimetres and the like. `notes` as in core::read_mesh.
core::Mesh read_object_mesh(const std::filesystem::path& path,
                            std::vector<std::string>* notes = nullptr);

/// The mesh of a session, as above; the session takes its offset, so that
/// `session.board_from_object` places what is returned. Tells `sink` what is doubtful.
core::Mesh read_session_mesh(capture::Session& session, ProgressSink& sink);

/// Whether it takes cameras to tell its outside: not of a closed surface of one part.
bool needs_cameras(const core::Mesh& mesh);

/// Lets cameras tell which side of an open surface is outside (core/mesh/winding.h). Tells `sink`
/// what was turned or is doubtful. `camera_from_board` are some poses, the more spread the better.
void face_cameras(core::Mesh& mesh, const capture::Session& session,
                  std::span<const Eigen::Isometry3d> camera_from_board, ProgressSink& sink);

/// A few poses of a session without reading all of it: from its file, or of frames near its start
/// by their tags. Empty when none of those is posed.
std::vector<Eigen::Isometry3d> probe_poses(const capture::Session& session,
                                           const FrameChoice& choice);

/// Sizes of board, object and camera positions against each other
/// (capture/plausibility/scene_check.h), where each command asks.
class SessionScene {
 public:
  /// Throws core::Error (bad_input) for sizes that cannot be; doubts go to `sink`. `session` and
  /// `mesh` are borrowed.
  SessionScene(const capture::Session& session, const core::Mesh& mesh, PoseSource source,
               ProgressSink& sink);

  /// Takes a pose into account. Throws core::Error (bad_input) once enough views are there and
  /// most of them cannot be.
  void see(const Eigen::Isometry3d& camera_from_board);

  /// After the last view: throws core::Error (bad_input) when most cannot be, tells doubts.
  void finish(ProgressSink& sink) const;

  [[nodiscard]] std::string description() const { return check_->description(); }

  /// Middle of the object in the board's frame.
  [[nodiscard]] const Eigen::Vector3d& object_in_board() const { return object_in_board_; }

  /// All of it for views that are there.
  static void check(const capture::Session& session, const core::Mesh& mesh, PoseSource source,
                    const std::vector<PosedFrame>& views, ProgressSink& sink);

 private:
  Eigen::Vector3d object_in_board_;
  std::optional<capture::Board> board_;
  std::unique_ptr<capture::SceneCheck> check_;
};

}  // namespace sheen::pipeline
