// One copy of the object is one billboard of two triangles. Camera frame, metres.
struct Copy {
  vec4 middle;
  vec4 right;  // half a side long
  vec4 down;
  uvec4 terms;  // first, count
};
layout(std430, binding = 0) readonly buffer Copies { Copy copies[]; };
layout(std140, binding = 0) uniform View {
  vec4 focal_principal;  // pixels
  vec4 size_near;        // width, height, pixels; what depths are divided by
};

layout(location = 0) out vec2 place;
layout(location = 1) flat out uvec2 terms;

void main() {
  Copy one = copies[gl_InstanceID];
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  vec3 point = one.middle.xyz + (2.0 * corner.x - 1.0) * one.right.xyz +
               (2.0 * corner.y - 1.0) * one.down.xyz;
  place = corner;
  terms = one.terms.xy;
  // Pixel (0, 0) is the middle of the first one. Depth is near / z: the nearest is the greatest.
  vec2 pixel = focal_principal.xy * point.xy + (focal_principal.zw + 0.5) * point.z;
  gl_Position = vec4(2.0 * pixel / size_near.xy - point.z, size_near.z, point.z);
}
