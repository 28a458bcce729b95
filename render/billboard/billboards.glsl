// SPDX-License-Identifier: MIT
// Filled by gl_billboard_renderer.cpp. One copy of the object, as the camera sees it.
struct Copy {
  vec4 box;           // pixels that may see it: left, top, right, bottom, the last ones beside it
  vec4 centre_reach;  // of the frames' sphere, camera frame, metres; reach of their images squared
  uvec2 frames;       // first, count
  float level;        // of detail, of all its frames
};
layout(std430, binding = 0) readonly buffer Copies { Copy copies[]; };
