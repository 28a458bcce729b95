// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/multi_eigenspace/multi_eigenspace.h"
#include "render/renderer.h"

#include <memory>

namespace sheen::render {

/// Draws eigenspaces on the CPU, no mesh needed: the picture towards the eye, on the billboard that
/// faces it, where at least half a pixel is covered. The same image on any number of threads. The
/// light field outlives it.
std::unique_ptr<Renderer> make_eigenspace_renderer(
    const fitting::multi_eigenspace::MultiEigenspace& model, int threads);

}  // namespace sheen::render
