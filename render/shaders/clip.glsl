// SPDX-License-Identifier: MIT
// Camera frame -> clip space whose w is the depth, so that attributes stay perspective-correct
// although the lens has moved the vertex. Depth values are near / depth: 1 at the near plane, 0 at
// infinity (reversed, clip control zero to one), which keeps full relative precision everywhere.
vec4 clip_from_camera(vec3 p) {
  // Beyond the valid radius go on in a straight line, also for points behind the camera: there
  // the polynomial would fold back into the image.
  float valid_radius = image.z;
  float r = length(p.xy);
  vec2 lens = r <= valid_radius * p.z ? distort(p.xy / p.z) * p.z
                                      : distort(p.xy * (valid_radius / r)) * (r / valid_radius);

  // Pixel (0, 0) is the centre of the first pixel; rows count downwards.
  vec2 from_corner = pinhole.xy * lens + (pinhole.zw + 0.5) * p.z;
  vec2 clip = 2.0 * from_corner / image.xy - p.z;
  return vec4(clip.x, -clip.y, eye_and_near.w, p.z);
}
