// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/depth_quads/depth_quads.h"
#include "render/renderer.h"

#include <memory>

namespace sheen::render {

/// Draws quads on the CPU, no mesh needed: every pixel's ray meets the planes of the quads around
/// it. `hard`: the nearest quad gives the colour, of equally near ones that of the better camera.
/// `weighted`: all quads that are about as near as the nearest, by their weights. The same image on
/// any number of threads. Where no quad is the image stays black and its mask 0.
std::unique_ptr<Renderer> make_quad_renderer(const fitting::depth_quads::DepthQuads& quads,
                                             int threads);

}  // namespace sheen::render
