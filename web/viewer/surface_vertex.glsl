// SPDX-License-Identifier: MIT
// Evaluates the patch of a vertex, as render/shaders/surface.vert; besides, its mean colour and how far
// it can be trusted towards the eye.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in uint patch_idx;
layout(location = 3) in vec2 place;
uniform mat4 clip_from_object;
uniform bool fading;
#ifdef MEANS
uniform samplerBuffer patch_means;
#endif
#ifdef CONFIDENCE
uniform samplerBuffer patch_confidence;  // 8 x 8 cells of directions per patch

float trust_of_cell(int patch_of_vertex, int column, int row) {
  return texelFetch(patch_confidence, 64 * patch_of_vertex + 8 * row + column).r;
}

// As fitting/confidence: bilinear between the cells' centres.
float trust_towards(int patch_of_vertex, vec2 uv) {
  vec2 at = clamp((uv + 1.0) * 4.0 - 0.5, 0.0, 7.0);
  ivec2 cell = min(ivec2(at), 6);
  vec2 part = at - vec2(cell);
  return mix(mix(trust_of_cell(patch_of_vertex, cell.x, cell.y),
                 trust_of_cell(patch_of_vertex, cell.x + 1, cell.y), part.x),
             mix(trust_of_cell(patch_of_vertex, cell.x, cell.y + 1),
                 trust_of_cell(patch_of_vertex, cell.x + 1, cell.y + 1), part.x), part.y);
}
#endif
out vec4 sums;        // colour sum and weight sum of the light field
out vec3 mean_sum;    // colour sum of the mean colours, of the same weight
out float trust;
out vec2 place_on_texture;
#ifdef BETWEEN
flat out int triangle_idx;
out vec3 corner_in_object;
out vec3 corner_normal;
#endif

void main() {
  int patch_of_vertex = int(patch_idx);
  vec2 uv = direction_on_disc(position, normal);
  sums = evaluate_patch(patch_of_vertex, uv);
  mean_sum = vec3(0.0);
#ifdef MEANS
  mean_sum = sums.a * texelFetch(patch_means, patch_of_vertex).rgb;
#endif
  trust = 1.0;
#ifdef CONFIDENCE
  trust = trust_towards(patch_of_vertex, uv);
  // One cell from where somebody looked the light field still counts in full.
  if (fading) sums.rgb = mix(mean_sum, sums.rgb, min(2.0 * trust, 1.0));
#endif
  place_on_texture = place;
#ifdef BETWEEN
  triangle_idx = gl_VertexID / 3;  // corners are drawn triangle by triangle
  corner_in_object = position;
  corner_normal = normal;
#endif
  gl_Position = clip_from_object * vec4(position, 1.0);
}
