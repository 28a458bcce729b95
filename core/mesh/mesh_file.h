// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace sheen::core {

/// More is no surface that a camera can tell apart; a small file may ask for it by instancing.
inline constexpr std::size_t kMostVertices = 20'000'000;
inline constexpr std::size_t kMostTriangles = 2 * kMostVertices;  // of a closed surface

/// What a mesh file says, before anything is rounded to single precision or repaired.
struct MeshFile {
  std::vector<Eigen::Vector3d> positions;  ///< as the file says
  /// Empty where the file has none, else one for every position, zero where it is missing.
  std::vector<Eigen::Vector3f> normals;
  /// sRGB in [0, 1], one for every position; empty where the file has none, or is no PLY.
  std::vector<Eigen::Vector3f> colours;
  std::vector<Eigen::Matrix<std::uint32_t, 3, 1>> triangles;
  std::vector<std::string> notes;  ///< what was passed over or is doubtful, without the file's name
};

}  // namespace sheen::core
