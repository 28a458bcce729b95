// SPDX-License-Identifier: MIT
// One score per patch on a scale of three colours, lit a little from the eye so that the shape can
// still be read. LOW, MIDDLE, HIGH and UNSEEN (of negative scores) are defined in front of this text.
layout(binding = 0) uniform samplerBuffer patch_scores;

vec4 evaluate_patch(int patch_idx, vec2 uv) {
  float score = min(texelFetch(patch_scores, patch_idx).r, 1.0);
  vec3 colour = score < 0.5 ? mix(LOW, MIDDLE, 2.0 * score) : mix(MIDDLE, HIGH, 2.0 * score - 1.0);
  if (score < 0.0) colour = UNSEEN;
  float cosine = sqrt(max(0.0, 1.0 - dot(uv, uv)));
  return vec4(colour * (0.6 + 0.4 * cosine), 1.0);
}
