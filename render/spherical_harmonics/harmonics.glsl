// SPDX-License-Identifier: MIT
// Real spherical harmonics in the order and signs of fitting/spherical_harmonics/basis.h.
// TERMS (4, 9 or 16) is written in front of this text; the patch's weight lies in the alpha channel
// of its first texel.
layout(binding = 0) uniform samplerBuffer patch_coefficients;

vec4 evaluate_patch(int patch_idx, vec2 uv) {
  uv /= max(length(uv), 1.0);
  float x = uv.x;
  float y = uv.y;
  float z = sqrt(max(1.0 - dot(uv, uv), 0.0));
  float Y[TERMS];
  Y[0] = 0.28209479177387814;
  Y[1] = 0.48860251190291992 * y;
  Y[2] = 0.48860251190291992 * z;
  Y[3] = 0.48860251190291992 * x;
#if TERMS >= 9
  Y[4] = 1.0925484305920792 * x * y;
  Y[5] = 1.0925484305920792 * y * z;
  Y[6] = 0.31539156525252005 * (3.0 * z * z - 1.0);
  Y[7] = 1.0925484305920792 * x * z;
  Y[8] = 0.5462742152960396 * (x * x - y * y);
#endif
#if TERMS >= 16
  Y[9] = 0.59004358992664352 * y * (3.0 * x * x - y * y);
  Y[10] = 2.8906114426405538 * x * y * z;
  Y[11] = 0.45704579946446577 * y * (5.0 * z * z - 1.0);
  Y[12] = 0.37317633259011546 * z * (5.0 * z * z - 3.0);
  Y[13] = 0.45704579946446577 * x * (5.0 * z * z - 1.0);
  Y[14] = 1.4453057213202769 * z * (x * x - y * y);
  Y[15] = 0.59004358992664352 * x * (x * x - 3.0 * y * y);
#endif
  int texel = patch_idx * TERMS;
  vec4 first = texelFetch(patch_coefficients, texel);
  vec3 colour = Y[0] * first.rgb;
  for (int term = 1; term < TERMS; ++term) {
    colour += Y[term] * texelFetch(patch_coefficients, texel + term).rgb;
  }
  return vec4(first.a * colour, first.a);
}
