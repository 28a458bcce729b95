// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "core/visibility/raster_kernels.h"
#include "core/visibility/visibility.h"

#include <memory>

namespace sheen::core {

/// Visibility by a depth map of the fronts, drawn on the CPU, and by rays where it leaves a doubt:
/// a vertex is hidden when all four pixels around it lie clearly in front of it, not hidden when
/// none does, and asked for by RayCaster::vertex_hidden otherwise (a few per cent, along contours
/// and creases).
///
/// Triangles are drawn with straight edges between the distorted pixels of their corners
/// (VertexView), which is right to a fraction of a pixel while they are small. A view that shows
/// triangles whose edges bend by more than that, or that reach behind the camera or beyond the lens
/// model and are not small, is answered by rays alone.
///
/// The same on any number of threads and with any of `kernels`. `view` must hold the projection of
/// the same mesh by the same camera and pose. Copies what it needs from the mesh.
std::unique_ptr<Visibility> make_raster_visibility(
    const Mesh& mesh, int threads, const RasterKernels& kernels = raster_kernel_sets().front());

}  // namespace sheen::core
