// SPDX-License-Identifier: MIT
#pragma once

#include "capture/session/session.h"

#include <Eigen/Geometry>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

namespace sheen::capture {

/// No honest session.json is larger.
inline constexpr std::size_t kMaxSessionBytes = std::size_t{1} << 20;

/// What a new session.json says (docs/session-format.md); paths are relative to its folder. Either
/// `video` or `images` is set, and `board` or `poses` or both.
struct SessionFile {
  std::optional<std::string> video{};
  std::optional<std::string> images{};  ///< printf pattern, images/%04d.png
  std::optional<double> fps{};
  std::optional<std::string> stamps{};
  std::optional<DepthFiles> depth{};
  std::string camera = "camera.yaml";  ///< empty: it is not known yet
  std::optional<std::string> board{};
  std::optional<std::string> poses{};
  std::string mesh = "object.ply";  ///< empty: there is none yet
  Eigen::Isometry3d board_from_object = Eigen::Isometry3d::Identity();
};

/// Copies a file that a session is made of. Throws core::Error (bad_input) for `from`.
void copy_into_session(const std::filesystem::path& from, const std::filesystem::path& to);

/// Writes `folder`/session.json. Throws core::Error (run_failed).
void write_session_file(const std::filesystem::path& folder, const SessionFile& session);

/// Names a camera file, a board or both in a session.json; the rest of it stays as it is. Throws
/// core::Error (bad_input) when it is no JSON object.
void write_camera_and_board(const std::filesystem::path& session_file,
                            const std::optional<std::string>& camera,
                            const std::optional<std::string>& board);

/// Writes the session.json `from` with another object, placed on the board as its file has it;
/// `mesh` is its path within the folder. Throws core::Error (bad_input) when `from` is no JSON
/// object.
void write_object(const std::filesystem::path& from, const std::filesystem::path& to,
                  const std::string& mesh);

/// Writes the session.json `from` with another place of the object as `to`, which may be the same
/// file; everything else stays as it is. Throws core::Error (bad_input) when it holds no object.
void write_board_from_object(const std::filesystem::path& from, const std::filesystem::path& to,
                             const Eigen::Isometry3d& board_from_object);

}  // namespace sheen::capture
