// SPDX-License-Identifier: MIT
// Sparse patches: constant or linear base, plus Wendland RBFs (eq. 5) from a fixed dictionary.
// A patch's first texel: the constant, and in alpha its number of RBFs + 32 for the linear base +
// 64 when it was observed. Then three texels of the linear base, if any, and one per RBF with its
// atom in alpha.
// PATCH_COUNT is written in front of this text; every patch has the same number of texels, which
// grows with the model.
layout(binding = 0) uniform samplerBuffer patch_terms;
layout(binding = 1) uniform samplerBuffer atoms;  // centre u, v; 1 / support

float wendland(float d) {
  float rest = max(1.0 - d, 0.0);
  float rest2 = rest * rest;
  return rest2 * rest2 * (4.0 * d + 1.0);
}

// Colour of the patch whose first texel is this one, and the weight 1, or 1 / 1024 where it was not
// observed.
vec4 sum_of_terms(samplerBuffer terms, int texel, vec2 uv) {
  uv /= max(length(uv), 1.0);
  vec4 first = texelFetch(terms, texel);
  int header = int(first.a + 0.5);
  vec3 colour = first.rgb;
  ++texel;
  if ((header & 32) != 0) {
    float z = sqrt(max(1.0 - dot(uv, uv), 0.0));
    colour += uv.x * texelFetch(terms, texel).rgb;
    colour += uv.y * texelFetch(terms, texel + 1).rgb;
    colour += z * texelFetch(terms, texel + 2).rgb;
    texel += 3;
  }
  for (int end = texel + (header & 31); texel < end; ++texel) {
    vec4 term = texelFetch(terms, texel);
    vec3 atom = texelFetch(atoms, int(term.a + 0.5)).xyz;
    colour += wendland(distance(uv, atom.xy) * atom.z) * term.rgb;
  }
  float weight = (header & 64) != 0 ? 1.0 : 1.0 / 1024.0;
  return vec4(colour, weight);
}

vec4 evaluate_patch(int patch_idx, vec2 uv) {
  int texels = textureSize(patch_terms) / PATCH_COUNT;
  vec4 sum = sum_of_terms(patch_terms, patch_idx * texels, uv);
  return vec4(sum.a * sum.rgb, sum.a);
}
