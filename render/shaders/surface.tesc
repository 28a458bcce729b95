// SPDX-License-Identifier: MIT
// Cuts edges into segments that the lens bends by less than a visible amount. The count depends on
// the edge alone, so that neighbouring triangles agree and no cracks open.
layout(vertices = 3) out;
layout(location = 0) in vec3 corner_in_camera[];
layout(location = 0) out vec3 control_in_camera[];
#ifdef SHADED
layout(location = 1) in vec4 corner_sums[];
layout(location = 1) out vec4 control_sums[];
#endif
#ifdef TEXTURED
layout(location = 2) in vec2 corner_place[];
layout(location = 2) out vec2 control_place[];
#endif
#ifdef BETWEEN
layout(location = 3) in vec3 corner_in_object[];
layout(location = 3) out vec3 control_in_object[];
layout(location = 4) in vec3 corner_normal[];
layout(location = 4) out vec3 control_normal[];
layout(location = 5) in int corner_triangle[];
layout(location = 5) out int control_triangle[];
#endif

float segments(vec3 a, vec3 b) {
  // Equal steps on the edge are longest in the image at its near end.
  float depth = max(min(a.z, b.z), eye_and_near.w);
  return clamp(ceil(distance(a, b) / (depth * image.w)), 1.0, 64.0);
}

void main() {
  control_in_camera[gl_InvocationID] = corner_in_camera[gl_InvocationID];
#ifdef SHADED
  control_sums[gl_InvocationID] = corner_sums[gl_InvocationID];
#endif
#ifdef TEXTURED
  control_place[gl_InvocationID] = corner_place[gl_InvocationID];
#endif
#ifdef BETWEEN
  control_in_object[gl_InvocationID] = corner_in_object[gl_InvocationID];
  control_normal[gl_InvocationID] = corner_normal[gl_InvocationID];
  control_triangle[gl_InvocationID] = corner_triangle[gl_InvocationID];
#endif
  if (gl_InvocationID == 0) {
    vec3 a = corner_in_camera[0];
    vec3 b = corner_in_camera[1];
    vec3 c = corner_in_camera[2];
    // Faces turned away are dropped here, before they are cut.
    bool front = dot(cross(b - a, c - a), a) < 0.0;
    vec3 outer = front ? vec3(segments(b, c), segments(c, a), segments(a, b)) : vec3(0.0);
    gl_TessLevelOuter[0] = outer.x;
    gl_TessLevelOuter[1] = outer.y;
    gl_TessLevelOuter[2] = outer.z;
    gl_TessLevelInner[0] = max(outer.x, max(outer.y, outer.z));
  }
}
