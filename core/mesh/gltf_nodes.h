// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/gltf_accessor.h"

#include <Eigen/Geometry>

#include <cstddef>
#include <vector>

namespace sheen::core {

/// A mesh of the scene where it stands.
struct GltfInstance {
  std::size_t mesh = 0;
  Eigen::Affine3d scene_from_mesh = Eigen::Affine3d::Identity();
  bool has_skin = false;
};

/// All meshes of the scene that the file shows by default (all nodes where it names no scene), in
/// depth-first order of its nodes; copies of EXT_mesh_gpu_instancing one by one. Throws GltfFault
/// for nodes that form no trees of bounded depth and for more instances than any surface has.
std::vector<GltfInstance> gltf_instances(const GltfContainer& gltf, GltfAccessors& accessors);

}  // namespace sheen::core
