// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace sheen::core {

/// A vertex as the raster reads it.
struct alignas(16) RasterVertex {
  float x, y;           ///< pixel, relative to the first one of the depth map
  float inverse_depth;  ///< 1 / depth, 1/m; 0 where the vertex has no pixel
  float unused;
};

/// Inverse depth of the nearest front per pixel, 0 where there is none. Whole groups of pixels are
/// written, and rows past the last one.
struct DepthMap {
  static constexpr int kGroup = 8;  ///< floats that stand at a multiple of their size in memory
  static constexpr int kExtraRows = 4;

  float* inverse_depth;  ///< aligned like a group
  std::int32_t width_px, height_px;
  std::size_t row;  ///< floats from row to row, a multiple of kGroup, >= width_px
};

/// Corner indices, counter-clockwise seen from outside.
struct TriangleCorners {
  const std::uint32_t *a, *b, *c;
  std::size_t count;  ///< multiple of 8
};

/// A front so large on the image that its edges may not be straight there.
struct LargeTriangle {
  std::uint32_t corners[3];
};

/// Where large triangles are noted; those beyond the capacity are counted only.
struct LargeTriangles {
  LargeTriangle* triangles;
  std::size_t capacity;
  std::size_t count;
};

/// The inner loops of the raster for one instruction set. All give the same bits.
struct RasterKernels {
  std::string_view instruction_set;  ///< "portable", "avx2"
  /// Draws the fronts among the triangles with straight edges between their vertices, nearest
  /// wins; notes those wider or higher than `large_px` and those that are not wholly projected.
  void (*draw)(const RasterVertex*, const TriangleCorners&, float large_px, const DepthMap&,
               LargeTriangles&);
};

/// All that this processor can run, the fastest first; "portable" is always among them.
const std::vector<RasterKernels>& raster_kernel_sets();

}  // namespace sheen::core
