// SPDX-License-Identifier: MIT
// The camera of core/geometry/camera.h. Filled by render/surface/view_block.h.
layout(std140, binding = 0) uniform View {
  mat4 camera_from_object;
  vec4 pinhole;       // focal length x, y; principal point x, y (pixels)
  vec4 lens[2];       // the lens's eight coefficients
  vec4 eye_and_near;  // eye in the object frame (metres); depth of the near plane (metres)
  vec4 image;       // width, height (pixels); valid radius, longest segment (in the plane z = 1)
  int lens_kind;      // LensKind
};
