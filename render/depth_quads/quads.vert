// SPDX-License-Identifier: MIT
// A cell of a photograph as a quad P0 + a U + b V in the camera's frame: as the CPU sets it up
// (render/depth_quads/screen_quads.h). What is drawn is the box of pixels that may see it.
layout(location = 0) in vec4 middle_along;     // in the plane z = 1 of the photograph
layout(location = 1) in vec4 down_depth_certainty;
layout(location = 2) in vec2 first_px;         // upper left corner in the photograph

layout(location = 0) flat out vec4 normal_per_volume;
layout(location = 1) flat out vec4 to_a_weight;
layout(location = 2) flat out vec3 to_b;
layout(location = 3) flat out vec2 first;

bool project(vec3 point, out vec2 pixel) {
  vec2 ideal = point.xy / point.z;
  pixel = pinhole.xy * distort(ideal) + pinhole.zw;
  return point.z > 0.0 && length(ideal) <= image.z;
}

void main() {
  gl_Position = vec4(0.0, 0.0, 0.0, 1.0);  // four corners at one place show nothing
  float depth_m = down_depth_certainty.z;
  float certainty = down_depth_certainty.w;
  if (certainty <= least_certainty || !(viewer_eye_share.z < depth_m)) return;

  // Put it at its depth.
  vec2 along = middle_along.zw;
  vec2 down = down_depth_certainty.xy;
  vec2 corner = middle_along.xy - 0.5 * (along + down);
  mat3 turn = mat3(viewer_from_photograph);
  vec3 P0 = (viewer_from_photograph * vec4(depth_m * corner, depth_m, 1.0)).xyz;
  vec3 U = turn * vec3(depth_m * along, 0.0);
  vec3 V = turn * vec3(depth_m * down, 0.0);

  // Find the pixels that may see it.
  vec2 low = vec2(1e9);
  vec2 high = vec2(-1e9);
  for (int i = 0; i < 4; ++i) {
    vec2 pixel;
    if (!project(P0 + float(i & 1) * U + float(i >> 1) * V, pixel)) return;
    low = min(low, pixel);
    high = max(high, pixel);
  }
  low = max(ceil(low), vec2(0.0));
  high = min(floor(high), image.xy - 1.0);
  if (any(greaterThan(low, high))) return;

  // Cramer's rule, in depths of the quad.
  vec3 across = cross(U, V) / (depth_m * depth_m);
  float volume = dot(P0, across);
  if (!(abs(volume) > 0.0)) return;
  float scale = sign(volume) / (depth_m * depth_m);
  normal_per_volume = vec4(sign(volume) * across, 1.0 / abs(volume));
  to_b = scale * cross(P0, U);
  first = first_px;

  // Weigh it.
  vec3 middle = depth_m * vec3(middle_along.xy, 1.0);
  vec3 between = normalize(middle) + normalize(viewer_eye_share.xyz - middle);
  float angle2 = dot(between, between);
  to_a_weight = vec4(scale * cross(V, P0), viewer_eye_share.w * certainty / (angle2 + least_angle2));

  vec2 place = mix(low, high + 1.0, vec2(gl_VertexID & 1, gl_VertexID >> 1));
  gl_Position = vec4(2.0 * place / image.xy - 1.0, 0.0, 1.0);
}
