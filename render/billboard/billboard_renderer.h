// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/billboard/billboards.h"
#include "render/context/context.h"
#include "render/renderer.h"

#include <Eigen/Geometry>

#include <memory>
#include <vector>

namespace sheen::render {

/// Draws billboards, no mesh needed. `nearest`: the frame whose direction is nearest to the
/// viewer's, on a plane through the object's centre; `blended`: those around it, each where its
/// depths put it. Where they cover less than half of a pixel the image stays black and its mask 0.
/// By OpenGL, or on the CPU where OpenGL is a program, too. Context and light field outlive it.
std::unique_ptr<Renderer> make_billboard_renderer(Context& context,
                                                  const fitting::billboard::Billboards& billboards,
                                                  int threads);

/// On the CPU. The same image on any number of threads.
std::unique_ptr<Renderer> make_cpu_billboard_renderer(
    const fitting::billboard::Billboards& billboards, int threads);

/// By OpenGL, every pixel by the CPU's arithmetic, so that the images differ by rounding alone. Any
/// number of copies of the object are drawn in one call; they stand at scene_from_object, and poses
/// of cameras are camera_from_scene. Nearer ones hide others, by the depths of their frames.
/// `threads` are for the rays of pixels. Drawing throws core::Error (run_failed) when the driver
/// cannot hold the frames that are needed or the image.
std::unique_ptr<Renderer> make_gl_billboard_renderer(
    Context& context, const fitting::billboard::Billboards& billboards,
    std::vector<Eigen::Isometry3d> scene_from_objects, int threads);

}  // namespace sheen::render
