// SPDX-License-Identifier: MIT
#pragma once

#include "render/gl/functions.h"

#include <opencv2/core/types.hpp>

namespace sheen::render::gl {

/// Draws `count` strips of four corners, which the program makes of nothing but their numbers, into
/// the bound framebuffer: what has the larger depth hides the rest, the first row of the image is
/// the first one of what is read back. `no_attributes` is a vertex array without any.
void draw_instanced_strips(const Functions& gl, GLuint program, GLuint no_attributes,
                           const cv::Size& size, GLsizei count);

}  // namespace sheen::render::gl
