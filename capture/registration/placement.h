// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"

#include <Eigen/Geometry>

#include <filesystem>
#include <vector>

namespace sheen::capture {

/// A point of the object and where it lies on the board; metres.
struct PointPair {
  Eigen::Vector3d in_object;
  Eigen::Vector3d in_board;
};

/// Lines `x y z  x y z`: a point in the mesh's frame, the same point in the board frame, metres;
/// `#` begins a comment. Throws core::Error (bad_input): unreadable lines, fewer than three pairs.
std::vector<PointPair> read_point_pairs(const std::filesystem::path& path);

/// The rigid motion that lays the object's points on the board's best, and how well.
struct PairPlacement {
  Eigen::Isometry3d board_from_object = Eigen::Isometry3d::Identity();
  double rms_m = 0;
};

/// Throws core::Error (bad_input) naming `path` when the points lie on one line.
PairPlacement place_by_pairs(const std::vector<PointPair>& pairs,
                             const std::filesystem::path& path);

/// The object upright on the board: its z axis up, its bounding box centred on the origin, its
/// lowest point on the paper, turned by `turn_rad` about z.
Eigen::Isometry3d place_upright(const core::Mesh& mesh, double turn_rad);

}  // namespace sheen::capture
