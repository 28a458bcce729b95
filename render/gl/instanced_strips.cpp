// SPDX-License-Identifier: MIT
#include "render/gl/instanced_strips.h"

namespace sheen::render::gl {

void draw_instanced_strips(const Functions& gl, GLuint program, GLuint no_attributes,
                           const cv::Size& size, GLsizei count) {
  constexpr GLsizei corners = 4;
  gl.Viewport(0, 0, size.width, size.height);
  gl.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  for (const GLenum off : {GL_CULL_FACE, GL_BLEND, GL_SCISSOR_TEST}) gl.Disable(off);
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthFunc(GL_GREATER);
  gl.DepthMask(GL_TRUE);
  gl.UseProgram(program);
  gl.BindVertexArray(no_attributes);
  gl.DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, corners, count);
  gl.BindVertexArray(0);
  gl.ClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
}

}  // namespace sheen::render::gl
