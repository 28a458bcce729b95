// SPDX-License-Identifier: MIT
// What the frames of a copy show of it along this pixel's ray: render/billboard/draw_frames.cpp for
// shaders, function by function.
layout(binding = 0) uniform sampler2DArray colours;  // times coverage, coverage; all levels
layout(binding = 1) uniform usampler2DArray shapes;  // coverage, depth code, whether supported

struct Frame {
  vec4 right_eye, up_eye, towards_eye;  // axes in the camera's frame; the eye along them, metres
  vec4 crop;                            // first and last pixel that the shape has
  float px_per_m;                       // at the centre
  float inverse_distance;               // of the camera that it was baked with, 1/m
  float share;
  int layer;
};
layout(std430, binding = 1) readonly buffer Frames { Frame frames[]; };
layout(std140, binding = 1) uniform Looks {
  float radius_m;
  int is_nearest;  // every frame on the plane through the centre
  int layers;      // of depths that a ray is compared with
  int steps;       // from one of them to the surface
  float missed;    // part of the radius by which a ray misses whose share is halved
};

layout(location = 0) flat in uint copy_idx;
// Of the vertices, not of the frame: llvmpipe takes the level of four neighbouring pixels from one
// of them, which has read no frame where it sees nothing.
layout(location = 1) flat in float level;
layout(location = 0) out vec4 colour;

struct Meeting {
  vec2 place_px;
  float share;    // 0: nowhere
  float along;    // depth along the camera's axis, metres
};

float towards_m(float code) { return radius_m * (code / 127.5 - 1.0); }

vec3 eye_of(Frame frame) { return vec3(frame.right_eye.w, frame.up_eye.w, frame.towards_eye.w); }

Meeting meet(Frame frame, vec3 ray, float z) {
  float along = (z - frame.towards_eye.w) / ray.z;
  if (!(along > 0.0 && along < 1e30)) return Meeting(vec2(0.0), 0.0, 0.0);
  vec3 point = eye_of(frame) + along * ray;
  float px_per_m = frame.px_per_m / (1.0 - point.z * frame.inverse_distance);
  float middle = 0.5 * float(textureSize(shapes, 0).x) - 0.5;
  return Meeting(vec2(point.x * px_per_m + middle, middle - point.y * px_per_m), frame.share, along);
}

float code_at(Frame frame, ivec2 pixel) {
  return float(texelFetch(shapes, ivec3(pixel, frame.layer), 0).y);
}

float depth_code(Frame frame, vec2 place_px) {
  vec2 at = clamp(place_px, frame.crop.xy, frame.crop.zw);
  ivec2 first = ivec2(at);
  ivec2 last = min(first + 1, ivec2(frame.crop.zw));
  vec2 part = at - vec2(first);
  return mix(mix(code_at(frame, first), code_at(frame, ivec2(last.x, first.y)), part.x),
             mix(code_at(frame, ivec2(first.x, last.y)), code_at(frame, last), part.x), part.y);
}

// Whether the surface of the nearest pixel is there or nearer.
bool is_below(Frame frame, vec2 place_px, float z) {
  vec2 at = place_px + 0.5;
  if (!all(greaterThanEqual(at, frame.crop.xy)) || !all(lessThan(at, frame.crop.zw + 1.0))) {
    return false;
  }
  uvec4 shape = texelFetch(shapes, ivec3(at, frame.layer), 0);
  return shape.x != 0u && towards_m(float(shape.y)) >= z;
}

bool is_supported(Frame frame, vec2 place_px) {
  vec2 at = clamp(place_px + 0.5, frame.crop.xy, frame.crop.zw);
  return texelFetch(shapes, ivec3(at, frame.layer), 0).z != 0u;
}

vec4 pixel_or_nothing(Frame frame, ivec2 pixel, int halved) {
  int side = textureSize(colours, halved).x;
  if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, ivec2(side)))) return vec4(0.0);
  return texelFetch(colours, ivec3(pixel, frame.layer), halved);
}

// Between four pixels, by the CPU's arithmetic: texture units have eight bits for it.
vec4 read_level(Frame frame, vec2 place_px, int halved) {
  float side = float(textureSize(colours, halved).x);
  vec2 at = (place_px + 0.5) * (side / float(textureSize(colours, 0).x)) - 0.5;
  if (!all(greaterThan(at, vec2(-1.0))) || !all(lessThan(at, vec2(side)))) return vec4(0.0);
  ivec2 first = ivec2(floor(at));
  vec2 part = at - vec2(first);
  return mix(mix(pixel_or_nothing(frame, first, halved),
                 pixel_or_nothing(frame, first + ivec2(1, 0), halved), part.x),
             mix(pixel_or_nothing(frame, first + ivec2(0, 1), halved),
                 pixel_or_nothing(frame, first + ivec2(1, 1), halved), part.x), part.y);
}

vec4 read(Frame frame, vec2 place_px) {
  float seen = clamp(level, 0.0, float(textureQueryLevels(colours) - 1));
  int fine = int(seen);
  float part = seen - float(fine);
  vec4 finer = read_level(frame, place_px, fine);
  return part == 0.0 ? finer : mix(finer, read_level(frame, place_px, fine + 1), part);
}

// The ray between two depths, the nearer one above the surface, the other one not.
Meeting meet_between(Frame frame, vec3 ray, float nearer, float farther) {
  Meeting meeting;
  float z = farther;
  float missing = 0.0;
  for (int i = 0; i < steps; ++i) {
    meeting = meet(frame, ray, z);
    float there = towards_m(depth_code(frame, meeting.place_px));
    missing = (there - z) / (missed * radius_m);
    z = clamp(there, farther, nearer);
  }
  meeting.share /= 1.0 + missing * missing;
  return meeting;
}

// Where it meets what the frame's depths describe first; where it only passes behind that, with a
// small share.
Meeting meet_surface(Frame frame, vec3 ray) {
  Meeting best = Meeting(vec2(-1e9), 0.0, 0.0);
  float nearer = radius_m;
  bool above = true;
  bool beside = true;
  for (int i = 1; i <= layers; ++i) {
    float z = radius_m * (1.0 - 2.0 * float(i) / float(layers));
    Meeting meeting = meet(frame, ray, z);
    if (meeting.share == 0.0) return meeting;
    bool below = is_below(frame, meeting.place_px, z);
    if (below && above) {
      Meeting crossing = meet_between(frame, ray, nearer, z);
      if (crossing.share > best.share) best = crossing;
      if (2.0 * crossing.share >= frame.share) return crossing;
      beside = false;
    }
    above = !below;
    nearer = z;
  }
  // Beside the object the frame shows nothing, and that counts.
  if (beside) best.share = frame.share;
  return best;
}

void main() {
  Copy copy = copies[copy_idx];
  vec2 xy = pixel_ray();
  vec3 ray = vec3(xy, 1.0);
  vec3 beside = cross(copy.centre_reach.xyz, ray);
  if (!is_ray(xy) || !(dot(beside, beside) <= copy.centre_reach.w * dot(ray, ray))) discard;
  vec4 sum = vec4(0.0);
  float shares = 0.0;
  float greatest = 0.0;
  float along = 0.0;
  bool supported = false;
  for (uint i = copy.frames.x; i < copy.frames.x + copy.frames.y; ++i) {
    Frame frame = frames[i];
    vec3 in_frame = vec3(dot(frame.right_eye.xyz, ray), dot(frame.up_eye.xyz, ray),
                         dot(frame.towards_eye.xyz, ray));
    Meeting meeting =
        is_nearest != 0 ? meet(frame, in_frame, 0.0) : meet_surface(frame, in_frame);
    if (!(meeting.share > 0.0)) continue;
    vec4 shown = read(frame, meeting.place_px);
    sum += meeting.share * shown;
    along += meeting.share * shown.a * meeting.along;
    shares += meeting.share;
    if (meeting.share <= greatest) continue;
    greatest = meeting.share;
    supported = is_supported(frame, meeting.place_px);
  }
  if (!(sum.a >= 0.5 * shares) || !(sum.a > 0.0)) discard;
  colour = vec4(clamp(sum.rgb / sum.a, 0.0, 1.0), supported ? 1.0 : 0.5);
  // 1 / depth, times 2^-40, which puts it within what depth buffers hold.
  gl_FragDepth = 9.094947e-13 * sum.a / along;
}
