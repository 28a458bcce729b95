// SPDX-License-Identifier: MIT
// Offsets of sparse patches, and where the model has anchors what they blend to. In front of this
// text stands sparse.glsl, its evaluate_patch called evaluate_offset.
// blends: of every vertex its normal (in alpha 1, or -1 where anchors are asked in mirrored
// directions), four anchors and their weights; then the normal of every anchor. One texel: no
// anchors.
layout(binding = 2) uniform samplerBuffer anchor_terms;
layout(binding = 3) uniform samplerBuffer blends;

vec4 evaluate_patch(int patch_idx, vec2 uv) {
  vec4 sums = evaluate_offset(patch_idx, uv);
  int anchor_count = textureSize(blends) - 3 * PATCH_COUNT;
  if (anchor_count <= 0) return sums;

  vec4 normal_and_side = texelFetch(blends, 3 * patch_idx);
  vec4 anchors = texelFetch(blends, 3 * patch_idx + 1);
  vec4 weights = texelFetch(blends, 3 * patch_idx + 2);
  float side = normal_and_side.a;
  uv /= max(length(uv), 1.0);
  vec3 w = tangent_frame(normal_and_side.xyz) * vec3(uv, side * sqrt(max(1.0 - dot(uv, uv), 0.0)));
  int texels = textureSize(anchor_terms) / anchor_count;
  for (int i = 0; i < 4 && weights[i] > 0.0; ++i) {
    int anchor = int(anchors[i] + 0.5);
    vec3 at = w * tangent_frame(texelFetch(blends, 3 * PATCH_COUNT + anchor).xyz);
    // Behind the anchor's horizon: on the rim.
    if (side * at.z < 0.0) at.xy /= max(length(at.xy), 1e-20);
    sums.rgb += sums.a * weights[i] * sum_of_terms(anchor_terms, anchor * texels, at.xy).rgb;
  }
  return sums;
}
