// SPDX-License-Identifier: MIT
// The box of pixels that may see a copy.
layout(std140, binding = 0) uniform Size {
  vec4 size_px;  // of the image
};
layout(location = 0) flat out uint copy_idx;
layout(location = 1) flat out float level;

void main() {
  vec4 box = copies[gl_InstanceID].box;
  copy_idx = uint(gl_InstanceID);
  level = copies[gl_InstanceID].level;
  vec2 place = mix(box.xy, box.zw, vec2(gl_VertexID & 1, gl_VertexID >> 1));
  gl_Position = vec4(2.0 * place / size_px.xy - 1.0, 0.0, 1.0);
}
