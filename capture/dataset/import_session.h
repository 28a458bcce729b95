// SPDX-License-Identifier: MIT
#pragma once

#include "capture/dataset/dataset.h"

#include <Eigen/Geometry>

#include <filesystem>

namespace sheen::capture {

/// What a session is made of.
struct SessionImport {
  Dataset dataset;
  std::filesystem::path images;   ///< the folder that the frames' names are relative to
  std::filesystem::path mesh;     ///< in the data set's axes and, like sessions' meshes, in metres
  double metres_per_unit = 1;     ///< of the data set's poses
  bool mesh_has_unit = false;     ///< the mesh is in the unit of the poses, not in metres
  std::filesystem::path board{};  ///< of the tags in the images; empty: none
  /// The session's stage, where the data set's axes are not to be it: of points in metres.
  Eigen::Isometry3d board_from_world = Eigen::Isometry3d::Identity();
};

/// Writes a session folder: images copied and numbered in the order of their names, camera, poses,
/// mesh. Beside its final name and moved into place. Throws core::Error (bad_input): several
/// cameras, images that are missing or of several formats, a name that is taken.
void write_imported_session(const SessionImport& import, const std::filesystem::path& folder);

}  // namespace sheen::capture
