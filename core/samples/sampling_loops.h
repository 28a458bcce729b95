// SPDX-License-Identifier: MIT
// Compiled once per instruction set, each time into a namespace of its own (SHEEN_LANES): nothing
// built for AVX2 may stand in for the portable code. For the same reason no inline function of the
// standard library is used here. Loops without branches, so that the compiler makes vectors of
// them.
#pragma once

#include "core/samples/sampling_kernels.h"

#include <cstdint>

namespace sheen::core::SHEEN_LANES {

// The lenses, once more for these instructions.
using Real = float;

inline float sqrt(float x) { return __builtin_sqrtf(x); }

/// Arc tangent of x >= 0, to 2e-7: a polynomial below tan(pi/8), else turned there by atan(x) =
/// pi/4 + atan((x - 1) / (x + 1)) or pi/2 - atan(1 / x).
inline float atan(float x) {
  const bool is_large = x > 2.41421356f;
  const bool is_middle = x > 0.41421356f;
  const float t = is_large ? -1.0f / x : is_middle ? (x - 1.0f) / (x + 1.0f) : x;
  const float base = is_large ? 1.57079633f : is_middle ? 0.78539816f : 0.0f;
  const float t2 = t * t;
  const float series =
      t + t * t2 *
              (-0.333329491539f +
               t2 * (0.199777106478f + t2 * (-0.138776856032f + t2 * 0.0805374449538f)));
  return base + series;
}

#define LENS_FUNCTION inline
#define LENS_ARRAY(name) const float* name
#define LENS_OUT(name) float& name
#include "core/geometry/lens/fisheye.lens"
#include "core/geometry/lens/rational.lens"
#undef LENS_FUNCTION
#undef LENS_ARRAY
#undef LENS_OUT

struct Rational {
  static void distort(const float* k, float x, float y, float& u, float& v) {
    distort_rational(k, x, y, u, v);
  }
};
struct Fisheye {
  static void distort(const float* k, float x, float y, float& u, float& v) {
    distort_fisheye(k, x, y, u, v);
  }
};

/// The first limit that fails, as a number of VertexRejection. Comparisons are written so that a
/// number that is not one fails.
inline std::int32_t first_failure(bool inside, float cosine, float min_cosine) {
  constexpr auto none = static_cast<std::int32_t>(VertexRejection::none);
  constexpr auto outside = static_cast<std::int32_t>(VertexRejection::outside_image);
  constexpr auto back_facing = static_cast<std::int32_t>(VertexRejection::back_facing);
  constexpr auto grazing = static_cast<std::int32_t>(VertexRejection::grazing);
  const std::int32_t by_cosine =
      cosine > 0.0f ? (cosine < min_cosine ? grazing : none) : back_facing;
  return inside ? by_cosine : outside;
}

/// View direction in the frame that `tangent_frame` derives from the normal.
struct Direction {
  float u, v, cosine;
};

inline Direction direction(float wx, float wy, float wz, float nx, float ny, float nz) {
  const float to_unit = 1.0f / __builtin_sqrtf(wx * wx + wy * wy + wz * wz);
  const float sign = __builtin_copysignf(1.0f, nz);
  const float a = -1.0f / (sign + nz);
  const float b = nx * ny * a;
  const float u = wx * (1.0f + sign * nx * nx * a) + wy * (sign * b) - wz * (sign * nx);
  const float v = wx * b + wy * (sign + ny * ny * a) - wz * ny;
  return {u * to_unit, v * to_unit, (wx * nx + wy * ny + wz * nz) * to_unit};
}

template <typename Lens>
inline void project_through(const ProjectionSetup& setup, const ProjectionColumns& at,
                            std::size_t begin, std::size_t end) {
  // Copies, since the compiler cannot know that the columns do not hold the setup.
  const ProjectionSetup s = setup;
  const ProjectionColumns c = at;
  const float* R = s.rotation;
#pragma GCC ivdep
  for (std::size_t i = begin; i < end; ++i) {
    const float x = c.x[i];
    const float y = c.y[i];
    const float z = c.z[i];
    const float depth = R[6] * x + R[7] * y + R[8] * z + s.translation[2];
    const float inverse_depth = 1.0f / depth;
    const float ideal_x = (R[0] * x + R[1] * y + R[2] * z + s.translation[0]) * inverse_depth;
    const float ideal_y = (R[3] * x + R[4] * y + R[5] * z + s.translation[1]) * inverse_depth;
    const float r2 = ideal_x * ideal_x + ideal_y * ideal_y;
    float distorted_x;
    float distorted_y;
    Lens::distort(s.distortion, ideal_x, ideal_y, distorted_x, distorted_y);
    const float x_px = s.focal_px[0] * distorted_x + s.principal_px[0];
    const float y_px = s.focal_px[1] * distorted_y + s.principal_px[1];
    const bool projects = (depth > 0.0f) & (r2 <= s.valid_radius2);
    const bool inside = projects & (x_px >= s.low_px) & (x_px <= s.high_px[0]) &
                        (y_px >= s.low_px) & (y_px <= s.high_px[1]);
    const Direction towards_eye =
        direction(s.eye[0] - x, s.eye[1] - y, s.eye[2] - z, c.nx[i], c.ny[i], c.nz[i]);
    c.x_px[i] = x_px;
    c.y_px[i] = y_px;
    c.depth_m[i] = projects ? depth : 0.0f;
    c.u[i] = towards_eye.u;
    c.v[i] = towards_eye.v;
    c.rejection[i] =
        static_cast<VertexRejection>(first_failure(inside, towards_eye.cosine, s.min_cosine));
  }
}

inline void project(const ProjectionSetup& setup, const ProjectionColumns& at, std::size_t begin,
                    std::size_t end) {
  switch (setup.lens) {
    case LensKind::rational:
      return project_through<Rational>(setup, at, begin, end);
    case LensKind::fisheye:
      return project_through<Fisheye>(setup, at, begin, end);
  }
}

/// So many samples at a time that everything between the steps stays in the nearest cache.
inline constexpr std::size_t kBlock = 64;

struct PixelBlock {
  float right[kBlock], down[kBlock];                      ///< fractions
  std::uint32_t upper_left[kBlock], upper_right[kBlock];  ///< bytes b g r from the lowest
  std::uint32_t lower_left[kBlock], lower_right[kBlock];
};

inline std::uint32_t word_at(const std::uint8_t* bytes) {
  std::uint32_t word;
  __builtin_memcpy(&word, bytes, sizeof word);
  return word;
}

/// Fetches the four pixels around every position. No byte beyond the image is read: the right
/// pixel is the upper part of a word that begins in the left one.
inline void fetch_pixels(const ImageView& image, const ReadingColumns& c, std::size_t first,
                         std::size_t count, PixelBlock& block) {
  for (std::size_t s = 0; s < count; ++s) {
    const std::uint32_t vertex_idx = c.patch[first + s];
    c.u[first + s] = c.view_u[vertex_idx];
    c.v[first + s] = c.view_v[vertex_idx];
    const float x_px = c.view_x_px[vertex_idx];
    const float y_px = c.view_y_px[vertex_idx];
    const auto x = static_cast<std::int32_t>(x_px);
    const auto y = static_cast<std::int32_t>(y_px);
    block.right[s] = x_px - static_cast<float>(x);
    block.down[s] = y_px - static_cast<float>(y);
    const std::uint8_t* upper =
        image.pixels + static_cast<std::size_t>(y) * image.row_bytes + 3 * x;
    const std::uint8_t* lower = upper + image.row_bytes;
    block.upper_left[s] = word_at(upper);
    block.upper_right[s] = word_at(upper + 2) >> 8;
    block.lower_left[s] = word_at(lower);
    block.lower_right[s] = word_at(lower + 2) >> 8;
  }
}

/// Bilinear value of one channel in [0, 1].
inline void blend_channel(const PixelBlock& block, int shift, std::size_t count, float* out) {
  constexpr float unit = 1.0f / 255.0f;
  const auto channel = [shift](std::uint32_t word) {
    return static_cast<float>(static_cast<std::int32_t>((word >> shift) & 255u));
  };
  for (std::size_t s = 0; s < count; ++s) {
    const float left = 1.0f - block.right[s];
    const float top =
        channel(block.upper_left[s]) * left + channel(block.upper_right[s]) * block.right[s];
    const float bottom =
        channel(block.lower_left[s]) * left + channel(block.lower_right[s]) * block.right[s];
    out[s] = (top * (1.0f - block.down[s]) + bottom * block.down[s]) * unit;
  }
}

inline void read(const ImageView& image, const ReadingColumns& c, std::size_t count) {
  PixelBlock block;
  for (std::size_t first = 0; first < count; first += kBlock) {
    const std::size_t size = count - first < kBlock ? count - first : kBlock;
    fetch_pixels(image, c, first, size, block);
    blend_channel(block, 0, size, c.b + first);
    blend_channel(block, 8, size, c.g + first);
    blend_channel(block, 16, size, c.r + first);
  }
}

}  // namespace sheen::core::SHEEN_LANES
