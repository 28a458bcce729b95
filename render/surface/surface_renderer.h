// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/patch_light_field.h"
#include "render/renderer.h"
#include "render/surface/patch_shader.h"

#include <functional>
#include <memory>

namespace sheen::render {

/// Patches by OpenGL, with the shader of their representation (render/surface/patch_shader.h) or,
/// where it has none, evaluated on the CPU for every view by `threads` threads. Patches are
/// evaluated in the vertex stage, colour sum and weight sum interpolated apart and divided per
/// fragment (eq. 7). The lens is exact at vertices; where it would bend an edge by more than 0.05
/// pixels triangles are tessellated, into at most 64 segments per edge. Pixels no ray of the lens
/// model reaches stay black. May be called from any thread, one at a time; the context is made
/// current there. Context, mesh and light field must outlive the renderer. Throws core::Error
/// (run_failed) for models or images too large for the driver.
std::unique_ptr<Renderer> make_gl_surface_renderer(Context& context, const core::Mesh& mesh,
                                                   const fitting::PatchLightField& light_field,
                                                   int threads = 1);

/// Makes what a mesh is painted with, by functions that outlive it.
using MakePaint = std::function<std::unique_ptr<PatchShader>(const gl::Functions&)>;

/// A mesh by OpenGL in the same way, with a paint of one's own. Drawing may read the light field.
std::unique_ptr<Renderer> make_painted_renderer(Context& context, const core::Mesh& mesh,
                                                const MakePaint& make_paint);

/// Reference without OpenGL: one ray per pixel, same interpolation. Exact at every pixel under any
/// lens distortion; slow.
std::unique_ptr<Renderer> make_reference_surface_renderer(
    const core::Mesh& mesh, const fitting::PatchLightField& light_field, int threads);

}  // namespace sheen::render
