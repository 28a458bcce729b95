// SPDX-License-Identifier: MIT
// Incremental weighted least squares: polynomials at centres, blended by Wendland weights (eqs. 5 to 7).
// CENTRES, TERMS, SUPPORT and centre_positions[] are written in front of this text.
layout(binding = 0) uniform samplerBuffer patch_coefficients;

float wendland(float d) {
  float rest = max(1.0 - d, 0.0);
  float rest2 = rest * rest;
  return rest2 * rest2 * (4.0 * d + 1.0);
}

vec3 polynomial(int texel, vec2 d) {
  vec3 value = texelFetch(patch_coefficients, texel).rgb;
#if TERMS >= 3
  value += d.x * texelFetch(patch_coefficients, texel + 1).rgb;
  value += d.y * texelFetch(patch_coefficients, texel + 2).rgb;
#endif
#if TERMS >= 6
  value += d.x * d.x * texelFetch(patch_coefficients, texel + 3).rgb;
  value += d.x * d.y * texelFetch(patch_coefficients, texel + 4).rgb;
  value += d.y * d.y * texelFetch(patch_coefficients, texel + 5).rgb;
#endif
  return value;
}

vec4 evaluate_patch(int patch_idx, vec2 uv) {
  uv /= max(length(uv), 1.0);
  int first = patch_idx * (CENTRES * TERMS);
  vec4 sums = vec4(0.0);
  for (int j = 0; j < CENTRES; ++j) {
    vec2 d = (uv - centre_positions[j]) / SUPPORT;
    sums += wendland(length(d)) * vec4(polynomial(first + j * TERMS, d), 1.0);
  }
  return sums * texelFetch(patch_coefficients, first).a;
}
