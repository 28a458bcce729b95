// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "core/mesh/mesh.h"
#include "core/visibility/visibility.h"

namespace sheen::core {

/// Visibility by Embree rays from the vertices that are still in question to the camera.
/// Builds its own hierarchy from the mesh; the mesh need not outlive it.
std::unique_ptr<Visibility> make_ray_visibility(const Mesh& mesh, int threads);

}  // namespace sheen::core
