// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/multi_eigenspace/multi_eigenspace.h"
#include "render/renderer.h"

#include <Eigen/Geometry>

#include <memory>
#include <vector>

namespace sheen::render {

/// Draws any number of copies of an object with OpenGL, all of them in one call: pictures lie in
/// two texture arrays, and every pixel of a billboard adds up the few layers that its copy names.
/// The cost is that of the pixels covered. Copies stand at scene_from_object; poses of cameras are
/// camera_from_scene, lens distortion is left out. Nearer copies hide others, by the planes of
/// their billboards. Context and model outlive it. Throws core::Error (run_failed) when the driver
/// cannot hold the pictures.
std::unique_ptr<Renderer> make_copies_renderer(
    Context& context, const fitting::multi_eigenspace::MultiEigenspace& model,
    std::vector<Eigen::Isometry3d> scene_from_objects);

}  // namespace sheen::render
