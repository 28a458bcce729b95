// SPDX-License-Identifier: MIT
// Closes the partition of unity, as render/shaders/surface.frag.
in vec4 sums;
in vec3 mean_sum;
in float trust;
in vec2 place_on_texture;
#ifdef TEXTURED
uniform sampler2D surface_texture;
#endif
#ifdef BETWEEN
flat in int triangle_idx;
in vec3 corner_in_object;
in vec3 corner_normal;
#endif
uniform bool fading;
uniform float split_px;       // left of it mean colours are shown
uniform bool show_confidence;
out vec4 colour;

vec3 shade_of(float t) {
  vec3 low = vec3(0.820, 0.286, 0.357);
  vec3 middle = vec3(0.929, 0.682, 0.286);
  vec3 high = vec3(0.165, 0.616, 0.561);
  return t < 0.5 ? mix(low, middle, 2.0 * t) : mix(middle, high, 2.0 * t - 1.0);
}

void main() {
  vec3 rgb = (gl_FragCoord.x < split_px ? mean_sum : sums.rgb) / sums.a;
#ifdef TEXTURED
  rgb += texture(surface_texture, place_on_texture).rgb;
#endif
#ifdef BETWEEN
  if (gl_FragCoord.x >= split_px) {
    float share = fading ? min(2.0 * trust, 1.0) : 1.0;
    rgb += share * between_patches(triangle_idx, corner_in_object, normalize(corner_normal));
  }
#endif
  rgb = clamp(rgb, 0.0, 1.0);
#ifdef CONFIDENCE
  if (show_confidence) rgb = shade_of(trust) * (0.35 + 0.65 * dot(rgb, vec3(0.299, 0.587, 0.114)));
#endif
  colour = vec4(rgb, 1.0);
}
