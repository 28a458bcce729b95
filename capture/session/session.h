// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/frame_source.h"
#include "core/geometry/camera.h"

#include <Eigen/Geometry>

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sheen::capture {

/// Depth images beside the frames, as session.json names them.
struct DepthFiles {
  std::string pattern;    ///< printf pattern such as depth/%04d.png
  double unit_m = 0.001;  ///< what a step of their numbers is, (0, 1]
};

/// A session folder (docs/session-format.md): what session.json says, checked.
struct Session {
  std::filesystem::path folder;
  /// Exactly one of the two is set: a video file, or a printf pattern such as images/%04d.png.
  std::optional<std::filesystem::path> video;
  std::optional<std::string> image_pattern;
  std::optional<double> fps;
  std::optional<std::filesystem::path>
      stamps;                       ///< frames.csv: when each frame was taken; wins over fps
  std::optional<DepthFiles> depth;  ///< read by DepthImages
  core::CameraModel camera;
  std::optional<std::filesystem::path> camera_file;  ///< camera.yaml, where it was read from a file
  std::optional<std::filesystem::path> board;        ///< board.yaml
  std::optional<std::filesystem::path> poses;        ///< poses.txt; wins over the board
  std::filesystem::path mesh;                        ///< empty: it has none yet
  /// Places the mesh, less `mesh_offset`, on the board; as read, the mesh as its file has it.
  Eigen::Isometry3d board_from_object = Eigen::Isometry3d::Identity();
  Eigen::Vector3d mesh_offset = Eigen::Vector3d::Zero();
  /// Usual light of the paper around each tag of the board, RGB, linear: frames are brought to it.
  /// Empty, as when read: they stay as they are (pipeline/light/session_light.h).
  std::map<int, Eigen::Vector3d> paper_light;
  std::vector<std::string> warnings;  ///< unknown keys, one line each

  /// Lets `board_from_object` place a mesh that lacks `offset` (core::Mesh::offset).
  void take_offset(const Eigen::Vector3d& offset);

  /// The camera that took a frame.
  [[nodiscard]] const core::CameraModel& camera_of(int /*frame_index*/) const { return camera; }
};

/// Reads and checks session.json and camera.yaml. Throws core::Error (bad_input) with one clear
/// line: missing file, later major version, path that leaves the folder, transform that is not
/// rigid.
Session open_session(const std::filesystem::path& folder);

/// Frames [start, end) of the session in recorded order; `index` counts from the recording's first
/// frame whatever `start` is. Throws core::Error for a missing or truncated video, an image whose
/// size differs from camera.yaml.
std::unique_ptr<FrameSource> open_frames(const Session& session, int start = 0,
                                         std::optional<int> end = std::nullopt);

}  // namespace sheen::capture
