// SPDX-License-Identifier: MIT
// Points inside a triangle: everything is linear on it until the lens is applied.
layout(triangles, equal_spacing, ccw) in;
layout(location = 0) in vec3 control_in_camera[];
#ifdef SHADED
layout(location = 1) in vec4 control_sums[];
layout(location = 1) out vec4 corner_sums;
#endif
#ifdef TEXTURED
layout(location = 2) in vec2 control_place[];
layout(location = 2) out vec2 corner_place;
#endif
#ifdef BETWEEN
layout(location = 3) in vec3 control_in_object[];
layout(location = 3) out vec3 corner_in_object;
layout(location = 4) in vec3 control_normal[];
layout(location = 4) out vec3 corner_normal;
layout(location = 5) in int control_triangle[];
layout(location = 5) flat out int triangle_idx;
#endif

void main() {
  // `precise` and the symmetric sum give both triangles at an edge the same point, bit by bit.
  vec3 weights = gl_TessCoord;
  precise vec3 in_camera = weights.x * control_in_camera[0] + weights.y * control_in_camera[1] +
                           weights.z * control_in_camera[2];
#ifdef SHADED
  corner_sums = weights.x * control_sums[0] + weights.y * control_sums[1] +
                weights.z * control_sums[2];
#endif
#ifdef TEXTURED
  corner_place = weights.x * control_place[0] + weights.y * control_place[1] +
                 weights.z * control_place[2];
#endif
#ifdef BETWEEN
  corner_in_object = weights.x * control_in_object[0] + weights.y * control_in_object[1] +
                     weights.z * control_in_object[2];
  corner_normal = weights.x * control_normal[0] + weights.y * control_normal[1] +
                  weights.z * control_normal[2];
  triangle_idx = control_triangle[0];
#endif
  gl_Position = clip_from_camera(in_camera);
}
