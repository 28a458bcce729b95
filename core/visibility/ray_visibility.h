// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "core/visibility/visibility.h"

#include <memory>

namespace sheen::core {

/// Visibility by Embree rays from the vertices that are still in question to the camera.
/// A vertex is hidden when a triangle whose front is turned towards the camera crosses the line
/// from the vertex to the camera's centre (RayCaster::vertex_hidden); triangles seen from behind do
/// not hide, as in a depth pass with back-face culling, so that meshes with holes behave the same
/// in both. Independent of the lens: lines of sight are straight, distortion only moves their
/// pixels. Builds its own hierarchy from the mesh; the mesh need not outlive it.
std::unique_ptr<Visibility> make_ray_visibility(const Mesh& mesh, int threads);

}  // namespace sheen::core
