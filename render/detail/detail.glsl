// SPDX-License-Identifier: MIT
// Offsets of sparse patches, and where the model has anchors what they blend to within a triangle. In
// front of this text stands sparse.glsl.
// blends: a texel that says how anchors are asked (1 same, -1 mirrored, 0 there are none), how many
// triangles there are, how many of the texels behind them belong to their lists and how many texels
// of anchor_terms an anchor has. Of every triangle its
// corners, with the first of its list in alpha and the number behind the last; the lists: an anchor,
// and the weights with which the corners blend it; the normal of every anchor.
layout(binding = 2) uniform samplerBuffer anchor_terms;
layout(binding = 3) uniform samplerBuffer blends;

// Weights of a triangle's corners at a place on it.
vec3 barycentric(vec3 a, vec3 b, vec3 c, vec3 place) {
  vec3 to_b = b - a, to_c = c - a, to_place = place - a;
  vec3 n = cross(to_b, to_c);
  float per = 1.0 / max(dot(n, n), 1e-37);
  float at_b = dot(cross(to_place, to_c), n) * per;
  float at_c = dot(cross(to_b, to_place), n) * per;
  return vec3(1.0 - at_b - at_c, at_b, at_c);
}

// What is added at a place of the surface with the normal n.
vec3 between_patches(int triangle_idx, vec3 place, vec3 n) {
  vec4 header = texelFetch(blends, 0);
  float side = header.x;
  vec3 sum = vec3(0.0);
  if (side == 0.0) return sum;

  vec4 a = texelFetch(blends, 3 * triangle_idx + 1);
  vec4 b = texelFetch(blends, 3 * triangle_idx + 2);
  vec4 c = texelFetch(blends, 3 * triangle_idx + 3);
  vec3 at = barycentric(a.xyz, b.xyz, c.xyz, place);
  int lists = 3 * int(header.y + 0.5) + 1;
  int normals = lists + int(header.z + 0.5);
  int texels = int(header.a + 0.5);
  vec3 w = normalize(eye_and_near.xyz - place);
  if (side < 0.0) w -= 2.0 * dot(n, w) * n;
  for (int i = lists + int(a.a + 0.5), end = lists + int(b.a + 0.5); i < end; ++i) {
    vec4 blend = texelFetch(blends, i);
    int anchor = int(blend.x + 0.5);
    vec3 asked = w * tangent_frame(texelFetch(blends, normals + anchor).xyz);
    // Behind the anchor's horizon: on the rim.
    if (side * asked.z < 0.0) asked.xy /= max(length(asked.xy), 1e-20);
    sum += dot(at, blend.yzw) * sum_of_terms(anchor_terms, anchor * texels, asked.xy).rgb;
  }
  return sum;
}
