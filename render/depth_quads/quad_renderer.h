// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/depth_quads/depth_quads.h"
#include "render/context/context.h"
#include "render/renderer.h"

#include <memory>

namespace sheen::render {

/// Draws quads, no mesh needed: every pixel's ray meets the planes of the quads around it. `hard`:
/// the nearest quad gives the colour, of equally near ones that of the better camera. `weighted`:
/// all quads that are about as near as the nearest, by their weights. Where no quad is the image
/// stays black and its mask 0. By OpenGL, or on the CPU where OpenGL is a program, too. Context and
/// light field outlive it.
std::unique_ptr<Renderer> make_quad_renderer(Context& context,
                                             const fitting::depth_quads::DepthQuads& quads,
                                             int threads);

/// On the CPU. The same image on any number of threads.
std::unique_ptr<Renderer> make_cpu_quad_renderer(const fitting::depth_quads::DepthQuads& quads,
                                                 int threads);

/// By OpenGL: all quads of a photograph in one call, set up by the vertex stage; every pixel by the
/// CPU's arithmetic, so the images differ by rounding alone. `threads` are for the rays of pixels.
/// Drawing throws core::Error (run_failed) when the driver cannot hold a photograph or an image.
std::unique_ptr<Renderer> make_gl_quad_renderer(Context& context,
                                                const fitting::depth_quads::DepthQuads& quads,
                                                int threads);

}  // namespace sheen::render
