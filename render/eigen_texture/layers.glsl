// SPDX-License-Identifier: MIT
// Basis textures, four to a layer, and what a layer adds to the mean: floats all the way.
layout(binding = 7) uniform sampler2D mean_texture;  // kSurfaceTextureUnit
layout(binding = 1) uniform sampler2DArray bases;
struct Layer {
  vec4 red, green, blue;  // what the four bases are multiplied with
};
layout(std430, binding = 0) readonly buffer Layers {
  int layer_count;
  Layer layers[];
};

vec3 colour_of(Layer layer, vec4 basis) {
  return vec3(dot(layer.red, basis), dot(layer.green, basis), dot(layer.blue, basis));
}
