// SPDX-License-Identifier: MIT
#pragma once

#include "core/visibility/visibility.h"
#include "render/context/context.h"

#include <memory>

namespace sheen::render {

/// Visibility by an OpenGL depth pass with back-face culling, as in the paper (section 4): a vertex
/// is hidden when the depth buffer is nearer than its own depth. May be called from any thread; the
/// context is made current there. Mesh and context must outlive it.
std::unique_ptr<core::Visibility> make_depth_visibility(Context& context, const core::Mesh& mesh);

}  // namespace sheen::render
