// The sum of a copy's terms, where at least half a pixel is covered.
layout(binding = 0) uniform sampler2DArray means;
layout(binding = 1) uniform sampler2DArray images;
struct Term {
  uint layer;  // of the images when the highest bit is set, else of the means
  float weight;
};
layout(std430, binding = 1) readonly buffer Terms { Term all_terms[]; };

layout(location = 0) in vec2 place;
layout(location = 1) flat in uvec2 terms;
layout(location = 0) out vec4 colour;

void main() {
  vec2 along = dFdx(place);
  vec2 across = dFdy(place);
  vec4 sum = vec4(0.0);
  for (uint i = terms.x; i < terms.x + terms.y; ++i) {
    Term term = all_terms[i];
    vec3 at = vec3(place, float(term.layer & 0x7fffffffu));
    vec4 value = (term.layer >> 31) == 0u ? textureGrad(means, at, along, across)
                                          : textureGrad(images, at, along, across);
    sum += term.weight * value;
  }
  if (!(sum.a >= 0.5)) discard;
  colour = vec4(clamp(sum.rgb, 0.0, 1.0), 1.0);
}
