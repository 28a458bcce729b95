// SPDX-License-Identifier: MIT
// Where this pixel's ray meets the quad, and what the photograph shows there, times its weight.
layout(binding = 0) uniform sampler2D photograph;

layout(location = 0) flat in vec4 normal_per_volume;
layout(location = 1) flat in vec4 to_a_weight;
layout(location = 2) flat in vec3 to_b;
layout(location = 3) flat in vec2 first;
layout(location = 0) out vec4 sum;

// Between four pixels, by the CPU's arithmetic: texture units have eight bits for it.
vec3 read_between(vec2 place) {
  ivec2 last = textureSize(photograph, 0) - 1;
  vec2 at = clamp(place, vec2(0.0), vec2(last));
  ivec2 upper = ivec2(at);
  ivec2 lower = min(upper + 1, last);
  vec2 part = at - vec2(upper);
  vec3 above = mix(texelFetch(photograph, upper, 0).rgb,
                   texelFetch(photograph, ivec2(lower.x, upper.y), 0).rgb, part.x);
  vec3 below = mix(texelFetch(photograph, ivec2(upper.x, lower.y), 0).rgb,
                   texelFetch(photograph, lower, 0).rgb, part.x);
  return mix(above, below, part.y);
}

void main() {
  vec2 xy = pixel_ray();
  vec3 ray = vec3(xy, 1.0);
  float across = dot(ray, normal_per_volume.xyz);
  vec2 along = vec2(dot(ray, to_a_weight.xyz), dot(ray, to_b));
  if (!is_ray(xy) || !(min(along.x, along.y) >= 0.0 && max(along.x, along.y) <= across)) discard;

  // 1 / depth, whose nearest is the greatest; 2^-40 keeps all its bits and puts it within what depth
  // buffers hold.
  sum = vec4(0.0);
  gl_FragDepth = across * normal_per_volume.w * nearer * 9.094947e-13;
  if (colours == 0) return;
  float weight = colours == 2 ? to_a_weight.w : 1.0;
  sum = weight * vec4(read_between(first + side_px / across * along), 1.0);
}
