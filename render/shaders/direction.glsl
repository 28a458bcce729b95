// SPDX-License-Identifier: MIT
// As in core/geometry/tangent_frame.h: tangent, bitangent and normal.
mat3 tangent_frame(vec3 n) {
  float s = floatBitsToInt(n.z) < 0 ? -1.0 : 1.0;
  float a = -1.0 / (s + n.z);
  float b = n.x * n.y * a;
  vec3 tangent = vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x);
  vec3 bitangent = vec3(b, s + n.y * n.y * a, -n.y);
  return mat3(tangent, bitangent, n);
}

// View direction of a patch on its unit disc.
vec2 direction_on_disc(vec3 position, vec3 n) {
  vec3 w = normalize(eye_and_near.xyz - position);
  return (w * tangent_frame(n)).xy;
}
