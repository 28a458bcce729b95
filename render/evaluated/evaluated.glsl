// SPDX-License-Identifier: MIT
// Colour sum and weight sum of every patch, evaluated on the CPU for the eye of this draw.
layout(binding = 0) uniform samplerBuffer patch_sums;

vec4 evaluate_patch(int patch_idx, vec2 uv) {
  return texelFetch(patch_sums, patch_idx);
}
