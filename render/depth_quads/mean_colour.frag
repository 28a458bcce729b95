// SPDX-License-Identifier: MIT
// Divides weighted sums of colours by their weights.
layout(binding = 0) uniform sampler2D sums;
layout(location = 0) out vec4 colour;

void main() {
  vec4 sum = texelFetch(sums, ivec2(gl_FragCoord.xy), 0);
  colour = sum.a > 0.0 ? vec4(sum.rgb / sum.a, 1.0) : vec4(0.0);
}
