// SPDX-License-Identifier: MIT
// A texture as it is. Its unit is kSurfaceTextureUnit.
layout(binding = 7) uniform sampler2D whole_texture;

vec3 surface_texture(vec2 place) { return texture(whole_texture, place).rgb; }
