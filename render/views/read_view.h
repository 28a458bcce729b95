// SPDX-License-Identifier: MIT
#pragma once

#include "render/gl/functions.h"
#include "render/renderer.h"

#include <opencv2/core/types.hpp>

namespace sheen::render {

/// What was drawn into the framebuffer that is bound, whose alpha is as `Renderer::draw` says.
RenderedView read_view(const gl::Functions& gl, const cv::Size& size_px);

}  // namespace sheen::render
