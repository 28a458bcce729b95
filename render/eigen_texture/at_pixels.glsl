// SPDX-License-Identifier: MIT
// Blending in screen space: the sums of a pixel.
vec3 surface_texture(vec2 place) {
  vec3 sum = texture(mean_texture, place).rgb;
  for (int i = 0; i < layer_count; ++i) {
    sum += colour_of(layers[i], texture(bases, vec3(place, float(i))));
  }
  return sum;
}
