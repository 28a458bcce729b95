// SPDX-License-Identifier: MIT
// Blending in texture space: the sums of a texel.
layout(location = 0) out vec4 colour;

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  vec3 sum = texelFetch(mean_texture, texel, 0).rgb;
  for (int i = 0; i < layer_count; ++i) {
    sum += colour_of(layers[i], texelFetch(bases, ivec3(texel, i), 0));
  }
  colour = vec4(clamp(sum, 0.0, 1.0), 1.0);
}
