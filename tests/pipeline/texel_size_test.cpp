// SPDX-License-Identifier: MIT
#include "pipeline/texel_size.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace sheen::pipeline {
namespace {

constexpr std::uint32_t kSide = 41;
constexpr float kSpacing_m = 0.001f;

/// A square of 40 x 40 squares of two triangles.
core::Mesh square() {
  core::Mesh mesh;
  for (std::uint32_t y = 0; y < kSide; ++y) {
    for (std::uint32_t x = 0; x < kSide; ++x) {
      mesh.positions.emplace_back(static_cast<float>(x) * kSpacing_m,
                                  static_cast<float>(y) * kSpacing_m, 0.0f);
      mesh.normals.emplace_back(0.0f, 0.0f, 1.0f);
      if (x == 0 || y == 0) continue;
      const std::uint32_t i = y * kSide + x;
      mesh.triangles.emplace_back(i - kSide - 1, i - kSide, i);
      mesh.triangles.emplace_back(i - kSide - 1, i, i - 1);
    }
  }
  return mesh;
}

// 1600 spacings squared of surface for 1681 vertices: two texels per vertex are reached below
// sqrt(1600 / 3362) = 0.69 spacings.
TEST(TexelSize, IsFinerThanVerticesFromTwoTexelsPerVertexOn) {
  const core::Mesh mesh = square();
  EXPECT_FALSE(are_finer_than_vertices(0.001, mesh));
  EXPECT_FALSE(are_finer_than_vertices(0.00070, mesh));
  EXPECT_TRUE(are_finer_than_vertices(0.00068, mesh));
  EXPECT_NEAR(texels_per_vertex(0.0005, mesh), 4 * 1600 / 1681.0, 1e-4);
}

TEST(TexelSize, NoSurfaceHasNoTexture) {
  core::Mesh mesh = square();
  mesh.triangles.clear();
  EXPECT_FALSE(are_finer_than_vertices(0.0001, mesh));
}

}  // namespace
}  // namespace sheen::pipeline
