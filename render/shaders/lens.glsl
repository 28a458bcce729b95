// SPDX-License-Identifier: MIT
// The camera of core/geometry/camera.h. Filled by render/surface/view_block.h.
layout(std140, binding = 0) uniform View {
  mat4 camera_from_object;
  vec4 pinhole;       // focal length x, y; principal point x, y (pixels)
  vec4 low_order;     // k1 k2 p1 p2
  vec4 high_order;    // k3 k4 k5 k6
  vec4 eye_and_near;  // eye in the object frame (metres); depth of the near plane (metres)
  vec4 image;       // width, height (pixels); valid radius, longest segment (in the plane z = 1)
};

vec2 distort(vec2 ideal) {
  float x = ideal.x;
  float y = ideal.y;
  float r2 = dot(ideal, ideal);
  float radial = (1.0 + r2 * (low_order.x + r2 * (low_order.y + r2 * high_order.x))) /
                 (1.0 + r2 * (high_order.y + r2 * (high_order.z + r2 * high_order.w)));
  float p1 = low_order.z;
  float p2 = low_order.w;
  return vec2(x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
              y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y);
}

// Camera frame -> clip space whose w is the depth, so that attributes stay perspective-correct
// although the lens has moved the vertex. Depth values are near / depth: 1 at the near plane, 0 at
// infinity (reversed, clip control zero to one), which keeps full relative precision everywhere.
vec4 clip_from_camera(vec3 p) {
  // Beyond the valid radius go on in a straight line, also for points behind the camera: there
  // the polynomial would fold back into the image.
  float valid_radius = image.z;
  float r = length(p.xy);
  vec2 lens = r <= valid_radius * p.z ? distort(p.xy / p.z) * p.z
                                      : distort(p.xy * (valid_radius / r)) * (r / valid_radius);

  // Pixel (0, 0) is the centre of the first pixel; rows count downwards.
  vec2 from_corner = pinhole.xy * lens + (pinhole.zw + 0.5) * p.z;
  vec2 clip = 2.0 * from_corner / image.xy - p.z;
  return vec4(clip.x, -clip.y, eye_and_near.w, p.z);
}
