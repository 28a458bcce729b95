// SPDX-License-Identifier: MIT
// One colour per patch; its weight lies in the alpha channel.
layout(binding = 0) uniform samplerBuffer patch_colours;

vec4 evaluate_patch(int patch_idx, vec2 uv) {
  vec4 texel = texelFetch(patch_colours, patch_idx);
  return vec4(texel.rgb * texel.a, texel.a);
}
