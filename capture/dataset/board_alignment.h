// SPDX-License-Identifier: MIT
#pragma once

#include "capture/dataset/dataset.h"
#include "capture/pose/board.h"

#include <Eigen/Geometry>

#include <filesystem>
#include <vector>

namespace sheen::capture {

/// A data set's axes and unit -> the board's frame in metres:
/// p_board = rotation (scale p_world) + shift.
struct BoardAlignment {
  double metres_per_unit = 1;
  Eigen::Isometry3d board_from_world = Eigen::Isometry3d::Identity();  ///< of scaled points
  std::size_t images = 0;                                              ///< that carried it
  double rms_m = 0;  ///< between their two places of the camera
};

/// A camera's pose twice: as the data set has it, and as the board's tags have it.
struct PosePair {
  Eigen::Isometry3d world_from_camera;
  Eigen::Isometry3d board_from_camera;
};

/// The similarity that lays the ones on the others: rotation as the mean of the pairs', scale and
/// shift by least squares over the places. Pairs three times further off than half of them are
/// left out. Throws core::Error (bad_input) for fewer than three, for cameras that do not move, and
/// for poses that contradict each other by more than a tenth of the way round; `path` is for
/// messages.
BoardAlignment align_pairs(const std::vector<PosePair>& pairs, const std::filesystem::path& path);

/// The same by the tags that the data set's images show. `images`: the folder of their names.
/// Throws core::Error (bad_input).
BoardAlignment align_to_board(const Dataset& dataset, const std::filesystem::path& images,
                              const std::filesystem::path& board_file);

}  // namespace sheen::capture
