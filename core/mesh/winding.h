// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"
#include "core/mesh/mesh.h"

#include <Eigen/Geometry>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace sheen::core {

/// Where the triangles of one connected surface run in both directions round, turns the smaller
/// share (by area), so that neighbours across an edge agree. Returns how many were turned.
/// One-sided surfaces and edges of three and more triangles stay as they are.
std::size_t unify_winding(Mesh& mesh);

/// Share of the given normals, weighted by area, that point to the side from which the triangles
/// run clockwise: 0 where normals and winding agree, 1 where all contradict. 0 without normals;
/// zero normals do not count.
double normals_against_winding(const Mesh& mesh);

/// A camera that looks at a mesh.
struct MeshView {
  const CameraModel* camera = nullptr;
  Eigen::Isometry3d camera_from_mesh = Eigen::Isometry3d::Identity();
};

/// What cameras see of a mesh: shares of its surface in the images.
struct SeenSides {
  std::size_t rays = 0;          ///< looks that met the mesh at all
  double back_share = 0;         ///< of those, from behind, before anything was turned
  std::size_t turned_parts = 0;  ///< connected parts that showed nothing but their back
  bool turned_normals = false;   ///< normals contradicted a winding that the cameras confirm
};

/// A surface that only ever shows its back to the cameras is inside out: turns such parts of the
/// mesh, with their normals; parts that no camera sees go with the rest. Normals that contradict
/// the winding which the cameras confirm are turned, too. Deterministic.
SeenSides face_cameras(Mesh& mesh, std::span<const MeshView> views);

}  // namespace sheen::core
