// SPDX-License-Identifier: MIT
// One level of a photograph, and how it is drawn. Filled by gl_quad_renderer.cpp.
layout(std140, binding = 1) uniform Sheet {
  mat4 viewer_from_photograph;
  vec4 viewer_eye_share;  // in the photograph's frame, metres; share of the photograph
  float side_px;          // of a quad in the photograph
  float nearer;           // depths are divided by this
  float least_certainty;  // what has no more is left out
  float least_angle2;
  int colours;            // 0: only depth counts, 1: each colour once, 2: colours by weight
};
