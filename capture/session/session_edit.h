// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>

#include <filesystem>
#include <string>

namespace sheen::capture {

/// Writes a copy of `session_file` (session.json) with another T_stage_object to `output`, which
/// may be the same file; everything else in it stays. Throws core::Error.
void write_board_from_object(const std::filesystem::path& session_file,
                             const std::filesystem::path& output,
                             const Eigen::Isometry3d& board_from_object);

/// Copies a file beside itself as NAME.before-STEP.EXT, so that a step that replaces it can be
/// taken back; where that exists, as NAME.before-STEP-2.EXT and so on: the first one stays. Returns
/// its path. Throws core::Error.
std::filesystem::path keep_before(const std::filesystem::path& file, const std::string& step);

}  // namespace sheen::capture
