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

/// Whether colours of vertices are read; a file that is broken in them alone has a shape.
enum class VertexColours { unread, read };

/// Within what a display shows; black for what is no number.
inline Eigen::Vector3f displayed(const Eigen::Vector3d& rgb) {
  Eigen::Vector3f colour;
  for (Eigen::Index c = 0; c < 3; ++c) {
    colour[c] = rgb[c] > 0 ? static_cast<float>(rgb[c] < 1 ? rgb[c] : 1) : 0.0f;
  }
  return colour;
}

/// What a mesh file says, before anything is rounded to single precision or repaired.
struct MeshFile {
  std::vector<Eigen::Vector3d> positions;  ///< as the file says
  /// Empty where the file has none, else one for every position, zero where it is missing.
  std::vector<Eigen::Vector3f> normals;
  /// sRGB in [0, 1], one for every position; empty where the file has none, or nobody asked.
  std::vector<Eigen::Vector3f> colours;
  std::vector<Eigen::Matrix<std::uint32_t, 3, 1>> triangles;
  std::vector<std::string> notes;  ///< what was passed over or is doubtful, without the file's name
};

}  // namespace sheen::core
