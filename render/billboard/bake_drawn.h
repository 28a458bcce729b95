// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "fitting/billboard/billboards.h"
#include "fitting/light_field.h"
#include "render/renderer.h"

namespace sheen::render {

/// Bakes all frames of `billboards` from what `renderer` draws of a light field of any kind; shape
/// and depth are the mesh's. Where the light field draws nothing of the mesh stand the colours of
/// its vertices, as unsupported. Orthographic frames are drawn from five hundred radii away, which
/// moves a point by at most a thousandth of the radius.
void bake_drawn(const core::Mesh& mesh, const fitting::LightField& light_field, Renderer& renderer,
                fitting::billboard::Billboards& billboards);

}  // namespace sheen::render
