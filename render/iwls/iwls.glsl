// SPDX-License-Identifier: MIT
// Incremental weighted least squares: polynomials at centres, blended by Wendland weights (eqs. 5 to 7).
// Four centres at a time, as the model holds them: the first texel of a patch is its weight, then
// [quad][term][r, g, b], a texel having one number of each centre of the quad.
// QUADS, TERMS, INVERSE_SUPPORT, centre_u[] and centre_v[] are written in front of this text.
layout(binding = 0) uniform samplerBuffer patch_coefficients;

vec4 wendland(vec4 distance2) {
  vec4 d = sqrt(distance2);
  vec4 rest = max(1.0 - d, 0.0);
  vec4 rest2 = rest * rest;
  return rest2 * rest2 * (4.0 * d + 1.0);
}

// One channel of the four polynomials, weighted and summed.
float weighted(int texel, vec4 theta, vec4 x, vec4 y) {
  vec4 value = texelFetch(patch_coefficients, texel);
#if TERMS >= 3
  value += x * texelFetch(patch_coefficients, texel + 3);
  value += y * texelFetch(patch_coefficients, texel + 6);
#endif
#if TERMS >= 6
  value += x * x * texelFetch(patch_coefficients, texel + 9);
  value += x * y * texelFetch(patch_coefficients, texel + 12);
  value += y * y * texelFetch(patch_coefficients, texel + 15);
#endif
  return dot(theta, value);
}

vec4 evaluate_patch(int patch_idx, vec2 uv) {
  uv /= max(length(uv), 1.0);
  int texel = patch_idx * (1 + QUADS * 3 * TERMS);
  float patch_weight = texelFetch(patch_coefficients, texel).r;
  ++texel;
  vec4 sums = vec4(0.0);
  for (int quad = 0; quad < QUADS; ++quad) {
    vec4 x = (uv.x - centre_u[quad]) * INVERSE_SUPPORT;
    vec4 y = (uv.y - centre_v[quad]) * INVERSE_SUPPORT;
    vec4 theta = wendland(x * x + y * y);
    sums += vec4(weighted(texel, theta, x, y), weighted(texel + 1, theta, x, y),
                 weighted(texel + 2, theta, x, y), dot(theta, vec4(1.0)));
    texel += 3 * TERMS;
  }
  return sums * patch_weight;
}
