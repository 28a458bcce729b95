// SPDX-License-Identifier: MIT
// The ray of this pixel where it meets the plane z = 1 of the camera; filled by
// render/views/ray_texture.h. Row 0 of what is drawn is the image's first row.
layout(binding = 6) uniform sampler2D pixel_rays;

vec2 pixel_ray() { return texelFetch(pixel_rays, ivec2(gl_FragCoord.xy), 0).xy; }

// Whether the lens model has one.
bool is_ray(vec2 ray) { return ray.x < 1e30; }
