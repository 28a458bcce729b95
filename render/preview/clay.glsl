// SPDX-License-Identifier: MIT
// Bare geometry under a lamp at the eye: the disc's third coordinate is the cosine of the view.
vec4 evaluate_patch(int patch_idx, vec2 uv) {
  float cosine = sqrt(max(0.0, 1.0 - dot(uv, uv)));
  return vec4(mix(vec3(0.16, 0.17, 0.19), vec3(0.78, 0.77, 0.74), cosine), 1.0);
}
