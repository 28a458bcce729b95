// SPDX-License-Identifier: MIT
// Closes the partition of unity: colour sum and weight sum were interpolated apart (eq. 7), and adds
// the texture, if there is one.
// The alpha channel tells background (0), seen surface without support (0.5) and with (1).
layout(location = 1) in vec4 corner_sums;
#ifdef TEXTURED
layout(location = 2) in vec2 corner_place;
#endif
#ifdef BETWEEN
layout(location = 3) in vec3 corner_in_object;
layout(location = 4) in vec3 corner_normal;
#ifdef TESSELLATED
layout(location = 5) flat in int triangle_idx;
#else
#define triangle_idx gl_PrimitiveID
#endif
#endif
layout(location = 0) out vec4 colour;

void main() {
  float alpha = corner_sums.a > 2.0 * UNSEEN_WEIGHT ? 1.0 : 0.5;
  vec3 rgb = corner_sums.rgb / corner_sums.a;
#ifdef TEXTURED
  rgb += surface_texture(corner_place);
#endif
#ifdef BETWEEN
  rgb += between_patches(triangle_idx, corner_in_object, normalize(corner_normal));
#endif
  colour = vec4(clamp(rgb, 0.0, 1.0), alpha);
}
