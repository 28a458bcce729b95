// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/billboard/billboards.h"
#include "render/renderer.h"

#include <memory>

namespace sheen::render {

/// Draws billboards on the CPU, no mesh needed. `nearest`: the frame whose direction is nearest to
/// the viewer's, on a plane through the object's centre; `blended`: those around it, each where
/// its depths put it. Where they cover less than half of a pixel the image stays black and
/// its mask 0. The same image on any number of threads. The light field outlives it.
std::unique_ptr<Renderer> make_billboard_renderer(const fitting::billboard::Billboards& billboards,
                                                  int threads);

}  // namespace sheen::render
