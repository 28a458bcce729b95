// SPDX-License-Identifier: MIT
// Compiled once per instruction set, each time into a namespace of its own (SHEEN_LANES): nothing
// built for AVX2 may stand in for the portable code. For the same reason no inline function of the
// standard library is used here. GCC's vectors are eight lanes wide under AVX2, four elsewhere;
// every lane does the same sums in the same order, so the width does not show in the result.
#pragma once

#include "core/visibility/raster_kernels.h"

#include <cstdint>

namespace sheen::core::SHEEN_LANES {

#ifdef __AVX2__
inline constexpr int kLanes = 8;
#else
inline constexpr int kLanes = 4;
#endif
inline constexpr int kRows = 4;
inline constexpr std::int32_t kGroup = DepthMap::kGroup;
static_assert(kGroup % kLanes == 0 && kRows <= DepthMap::kExtraRows);

using Float4 = float __attribute__((vector_size(16)));
using Floats = float __attribute__((vector_size(4 * kLanes)));
using PixelFloats = float __attribute__((vector_size(4 * kLanes), may_alias));
using Ints = std::int32_t __attribute__((vector_size(4 * kLanes)));

#define SHEEN_INLINE __attribute__((always_inline)) inline

/// Edges are moved out by so much, so that rounding leaves no gap between neighbours, in pixels.
inline constexpr float kDilation_px = 1e-3f;
/// Below this twice the area is taken for a line seen from its end, square pixels.
inline constexpr float kLeastArea_px2 = 1e-5f;

SHEEN_INLINE Floats splat(float x) {
  return x - Floats{};
}
SHEEN_INLINE Floats least(Floats a, Floats b) {
  return a < b ? a : b;
}
SHEEN_INLINE Floats most(Floats a, Floats b) {
  return a > b ? a : b;
}
SHEEN_INLINE Floats magnitude(Floats a) {
  return a < 0.0f ? -a : a;
}
/// Of numbers in the range of int32; not a number becomes anything.
SHEEN_INLINE Ints round_up(Floats a) {
  const Ints whole = __builtin_convertvector(a, Ints);
  return whole - (a > __builtin_convertvector(whole, Floats));  // true is -1
}
SHEEN_INLINE Ints round_down(Floats a) {
  const Ints whole = __builtin_convertvector(a, Ints);
  return whole + (a < __builtin_convertvector(whole, Floats));
}

/// The same corner of kLanes triangles.
struct Corner {
  Floats x, y, inverse_depth;
};

SHEEN_INLINE void transpose(Float4 r0, Float4 r1, Float4 r2, Float4 r3, Float4& x, Float4& y,
                            Float4& z) {
  const Float4 xy01 = __builtin_shufflevector(r0, r1, 0, 4, 1, 5);
  const Float4 xy23 = __builtin_shufflevector(r2, r3, 0, 4, 1, 5);
  const Float4 z01 = __builtin_shufflevector(r0, r1, 2, 6, 3, 7);
  const Float4 z23 = __builtin_shufflevector(r2, r3, 2, 6, 3, 7);
  x = __builtin_shufflevector(xy01, xy23, 0, 1, 4, 5);
  y = __builtin_shufflevector(xy01, xy23, 2, 3, 6, 7);
  z = __builtin_shufflevector(z01, z23, 0, 1, 4, 5);
}

SHEEN_INLINE Corner gather(const RasterVertex* vertices, const std::uint32_t* idx) {
  const auto vertex = [&](int lane) {
    return *reinterpret_cast<const Float4*>(vertices + idx[lane]);
  };
  Float4 x;
  Float4 y;
  Float4 z;
  transpose(vertex(0), vertex(1), vertex(2), vertex(3), x, y, z);
#ifdef __AVX2__
  Float4 x_high;
  Float4 y_high;
  Float4 z_high;
  transpose(vertex(4), vertex(5), vertex(6), vertex(7), x_high, y_high, z_high);
  const auto join = [](Float4 low, Float4 high) {
    return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
  };
  return {join(x, x_high), join(y, y_high), join(z, z_high)};
#else
  return {x, y, z};
#endif
}

/// Everything that drawing needs, lane by lane. An edge function is c + a dx + b dy, not negative
/// inside, dx and dy counted from the first row and the group of pixels that holds the first
/// column.
struct Setup {
  Floats a[3], b[3], c[3];
  Floats inverse_depth, inverse_depth_dx, inverse_depth_dy, nearest;
  Ints left, top, right, bottom;
  Ints drawn;  ///< -1 where the triangle is a front and may cover a pixel's centre
  Ints large;  ///< -1 where it has to be looked at again
};

/// The edge from p to q; fronts have positive area with corners a, c, b (y points down).
SHEEN_INLINE void set_edge(Setup& s, int edge, const Corner& p, const Corner& q, Floats x0,
                           Floats y0) {
  const Floats a = p.y - q.y;
  const Floats b = q.x - p.x;
  s.a[edge] = a;
  s.b[edge] = b;
  s.c[edge] = (x0 - p.x) * a + (y0 - p.y) * b + kDilation_px * (magnitude(a) + magnitude(b));
}

SHEEN_INLINE Setup set_up(const Corner& p0, const Corner& p2, const Corner& p1, float large_px,
                          const DepthMap& map) {
  Setup s;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled below
  // Which pixel centres the triangle may cover.
  const Floats left = least(p0.x, least(p1.x, p2.x));
  const Floats right = most(p0.x, most(p1.x, p2.x));
  const Floats top = least(p0.y, least(p1.y, p2.y));
  const Floats bottom = most(p0.y, most(p1.y, p2.y));
  const auto width = static_cast<float>(map.width_px);
  const auto height = static_cast<float>(map.height_px);
  s.left = round_up(most(least(left, splat(width)), splat(0.0f)));
  s.top = round_up(most(least(top, splat(height)), splat(0.0f)));
  s.right = round_down(least(most(right, splat(-1.0f)), splat(width - 1.0f)));
  s.bottom = round_down(least(most(bottom, splat(-1.0f)), splat(height - 1.0f)));

  // Refuse backs, lines and what lies between the centres.
  const Floats area = (p1.x - p0.x) * (p2.y - p0.y) - (p2.x - p0.x) * (p1.y - p0.y);
  const Floats farthest = least(p0.inverse_depth, least(p1.inverse_depth, p2.inverse_depth));
  const Ints projected = farthest > 0.0f;
  s.drawn = projected & (area > kLeastArea_px2) & (s.left <= s.right) & (s.top <= s.bottom);
  s.large = (s.drawn & ((right - left > large_px) | (bottom - top > large_px))) | ~projected;

  // Edges and the plane of the inverse depth, which is linear on the image.
  const Floats x0 = __builtin_convertvector(s.left & -kGroup, Floats);
  const Floats y0 = __builtin_convertvector(s.top, Floats);
  set_edge(s, 0, p0, p1, x0, y0);
  set_edge(s, 1, p1, p2, x0, y0);
  set_edge(s, 2, p2, p0, x0, y0);
  const Floats d1 = p1.inverse_depth - p0.inverse_depth;
  const Floats d2 = p2.inverse_depth - p0.inverse_depth;
  const Floats per_area = 1.0f / area;
  s.inverse_depth_dx = (d1 * (p2.y - p0.y) - d2 * (p1.y - p0.y)) * per_area;
  s.inverse_depth_dy = (d2 * (p1.x - p0.x) - d1 * (p2.x - p0.x)) * per_area;
  s.inverse_depth =
      p0.inverse_depth + (x0 - p0.x) * s.inverse_depth_dx + (y0 - p0.y) * s.inverse_depth_dy;
  s.nearest = most(p0.inverse_depth, most(p1.inverse_depth, p2.inverse_depth));
  return s;
}

SHEEN_INLINE Floats counting() {
  Floats numbers;
  for (int lane = 0; lane < kLanes; ++lane) numbers[lane] = static_cast<float>(lane);
  return numbers;
}

/// Draws one lane's triangle, kLanes pixels of a few rows at a time: most triangles are not higher,
/// and a wrong guess of the loop's end costs more than a row. Vectors begin at multiples of their
/// length, because neighbouring triangles share pixels and a processor hands what was just stored
/// to a load at the same place only.
SHEEN_INLINE void draw_lane(const Setup& s, int lane, const DepthMap& map) {
  const std::int32_t origin = s.left[lane] & -kGroup;
  const std::int32_t begin = (s.left[lane] & -kLanes) - origin;
  const std::int32_t end = s.right[lane] - origin;
  const std::int32_t top = s.top[lane];
  const std::int32_t height = s.bottom[lane] - top;
  const Floats b0 = splat(s.b[0][lane]), b1 = splat(s.b[1][lane]), b2 = splat(s.b[2][lane]);
  const Floats down = splat(s.inverse_depth_dy[lane]);
  const Floats nearest = splat(s.nearest[lane]);
  float* row = map.inverse_depth + static_cast<std::size_t>(top) * map.row + origin;
  for (std::int32_t first = begin; first <= end; first += kLanes) {
    const Floats dx = counting() + static_cast<float>(first);
    Floats edge0 = s.c[0][lane] + s.a[0][lane] * dx;
    Floats edge1 = s.c[1][lane] + s.a[1][lane] * dx;
    Floats edge2 = s.c[2][lane] + s.a[2][lane] * dx;
    Floats plane = s.inverse_depth[lane] + s.inverse_depth_dx[lane] * dx;
    float* pixels = row + first;
    for (std::int32_t y = 0; y <= height; y += kRows) {
      for (int r = 0; r < kRows; ++r, pixels += map.row) {
        const Floats inverse_depth = least(plane, nearest);
        auto* place = reinterpret_cast<PixelFloats*>(pixels);
        const Floats before = *place;
        const Ints covered = least(edge0, least(edge1, edge2)) >= 0.0f;
        *place = (covered & (inverse_depth > before)) ? inverse_depth : before;
        edge0 += b0;
        edge1 += b1;
        edge2 += b2;
        plane += down;
      }
    }
  }
}

/// One bit per lane that is not zero.
SHEEN_INLINE unsigned bits_of(Ints mask) {
  unsigned bits = 0;
  for (int lane = 0; lane < kLanes; ++lane) {
    bits |= static_cast<unsigned>(mask[lane] & 1) << lane;
  }
  return bits;
}

/// Notes a triangle that has to be looked at again.
inline void note_large(const TriangleCorners& triangles, std::size_t t, LargeTriangles& large) {
  if (large.count < large.capacity) {
    large.triangles[large.count] = {{triangles.a[t], triangles.b[t], triangles.c[t]}};
  }
  ++large.count;
}

inline void draw(const RasterVertex* vertices, const TriangleCorners& triangles, float large_px,
                 const DepthMap& depth_map, LargeTriangles& large) {
  const DepthMap map = depth_map;  // a copy: the compiler cannot know that pixels are not its parts
  for (std::size_t first = 0; first < triangles.count; first += kLanes) {
    const Setup s =
        set_up(gather(vertices, triangles.a + first), gather(vertices, triangles.b + first),
               gather(vertices, triangles.c + first), large_px, map);
    for (unsigned lanes = bits_of(s.large); lanes != 0; lanes &= lanes - 1) {
      note_large(triangles, first + static_cast<std::size_t>(__builtin_ctz(lanes)), large);
    }
    for (unsigned lanes = bits_of(s.drawn); lanes != 0; lanes &= lanes - 1) {
      draw_lane(s, __builtin_ctz(lanes), map);
    }
  }
}

}  // namespace sheen::core::SHEEN_LANES
