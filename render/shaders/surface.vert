// SPDX-License-Identifier: MIT
// Evaluates the patch of a vertex. SHADED: colours wanted, else depth only. TESSELLATED: the lens is
// applied after tessellation.
#if defined(TESSELLATED) && defined(BETWEEN)
// What lies between patches asks for the triangle. Some drivers lose count of them in gl_PrimitiveID
// where they tessellate, so every triangle is drawn with three vertices of its own, looked up here.
layout(binding = 4) uniform usamplerBuffer vertex_of_corner;
layout(binding = 5) uniform usamplerBuffer vertices;  // two texels each, as they lie in memory
layout(location = 5) out int corner_triangle;
vec3 position, normal;
vec2 place;
uint patch_idx;

void look_up_vertex() {
  int first = 2 * int(texelFetch(vertex_of_corner, gl_VertexID).r);
  uvec4 upper = texelFetch(vertices, first);
  uvec4 lower = texelFetch(vertices, first + 1);
  position = uintBitsToFloat(upper.xyz);
  normal = uintBitsToFloat(uvec3(upper.w, lower.xy));
  place = unpackUnorm2x16(lower.z);
  patch_idx = lower.w;
  corner_triangle = gl_VertexID / 3;
}
#else
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
#ifdef TEXTURED
layout(location = 2) in vec2 place;
layout(location = 3) in uint patch_idx;
#endif
#endif
#ifdef TEXTURED
// TEXTURED: a texture is added; vertices are repeated where it has seams.
layout(location = 2) out vec2 corner_place;
#endif

#ifdef BETWEEN
// BETWEEN: more is added that depends on the place.
layout(location = 3) out vec3 corner_in_object;
layout(location = 4) out vec3 corner_normal;
#endif
#ifdef TESSELLATED
layout(location = 0) out vec3 corner_in_camera;
#endif
#ifdef SHADED
layout(location = 1) out vec4 corner_sums;
#endif

void main() {
#if defined(TESSELLATED) && defined(BETWEEN)
  look_up_vertex();
#endif
  vec3 in_camera = (camera_from_object * vec4(position, 1.0)).xyz;
#ifdef SHADED
#ifdef TEXTURED
  int patch_of_vertex = int(patch_idx);
  corner_place = place;
#else
  int patch_of_vertex = gl_VertexID;
#endif
  corner_sums = evaluate_patch(patch_of_vertex, direction_on_disc(position, normal));
#endif
#ifdef BETWEEN
  corner_in_object = position;
  corner_normal = normal;
#endif
#ifdef TESSELLATED
  corner_in_camera = in_camera;
#else
  gl_Position = clip_from_camera(in_camera);
#endif
}
