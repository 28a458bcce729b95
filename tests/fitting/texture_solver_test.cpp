// SPDX-License-Identifier: MIT
#include "fitting/detail/texture_solver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace sheen::fitting::detail {
namespace {

constexpr std::size_t kWidth = 24;
constexpr std::size_t kHeight = 18;

// Without vertices every difference belongs to the texture.
const core::Mesh kNoMesh;
const SurfaceTexels kNoSurface{core::Atlas{}};

std::vector<TexelSums> empty_sums() {
  return std::vector<TexelSums>(kWidth * kHeight);
}

/// A grey pixel that sees this place.
void see(const TexelGrid& grid, const Eigen::Vector2f& place, float cosine, std::uint32_t value) {
  const auto grey = static_cast<float>(value);
  add_pixel(grid, readings_at(place.x() + Four{}, place.y() + Four{}, cosine + Four{}), 0,
            Four{1, grey, grey, grey});
}

/// A pixel that sees the texel's centre moved by (right, below) texels.
void see(std::vector<TexelSums>& sums, std::size_t x, std::size_t y, float right, float below,
         float cosine, std::uint32_t value) {
  see({sums.data(), kWidth},
      {static_cast<float>(x) + 0.5f + right, static_cast<float>(y) + 0.5f + below}, cosine, value);
}

float bilinear(const std::vector<float>& texture, std::size_t x, std::size_t y, float right,
               float below) {
  const std::size_t i = y * kWidth + x;
  return (1 - below) * ((1 - right) * texture[i] + right * texture[i + 1]) +
         below * ((1 - right) * texture[i + kWidth] + right * texture[i + kWidth + 1]);
}

Planes filled(float value) {
  Planes planes;
  for (auto& plane : planes) plane.assign(kWidth * kHeight, value);
  return planes;
}

// A pixel at a texel's very centre says what the texel is, to nobody else.
TEST(TexelSums, APixelAtACentreBelongsToOneTexel) {
  auto sums = empty_sums();
  see(sums, 5, 7, 0, 0, 1, 200);
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const bool is_it = i == 7 * kWidth + 5;
    EXPECT_EQ(sums[i].weight, is_it ? kCosineUnits * kReadingUnits : 0);
    EXPECT_EQ(sums[i].right + sums[i].below + sums[i].below_right + sums[i].below_left, 0u);
  }
  EXPECT_EQ(mean_texture(sums)[1][7 * kWidth + 5], 200.0f);
}

// Sums of integers: equal in any order.
TEST(TexelSums, DoNotDependOnTheOrderOfPixels) {
  std::mt19937 random(5);
  struct Pixel {
    std::size_t x, y;
    float right, below, cosine;
    std::uint32_t value;
  };
  std::vector<Pixel> pixels;
  const auto unit = [&] { return static_cast<float>(random()) / 4294967296.0f; };
  for (int i = 0; i < 3000; ++i) {
    pixels.push_back({1 + random() % (kWidth - 3), 1 + random() % (kHeight - 3), unit(), unit(),
                      0.2f + 0.8f * unit(), static_cast<std::uint32_t>(random() % 256)});
  }
  const auto sums_of = [&] {
    auto sums = empty_sums();
    for (const Pixel& p : pixels) see(sums, p.x, p.y, p.right, p.below, p.cosine, p.value);
    return sums;
  };
  const auto one = sums_of();
  std::ranges::shuffle(pixels, random);
  const auto other = sums_of();
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].weight, other[i].weight);
    EXPECT_EQ(one[i].below_left, other[i].below_left);
    EXPECT_EQ(one[i].colour, other[i].colour);
  }
}

/// A texture that changes fast, and pixels without noise of its bilinear reading at places all
/// over.
class Sharpening : public ::testing::Test {
 protected:
  Sharpening() : truth_(kWidth * kHeight), sums_(empty_sums()) {
    std::mt19937 random(9);
    for (float& texel : truth_) texel = 40.0f + static_cast<float>(random() % 160);
    for (int i = 0; i < 60'000; ++i) {
      const std::size_t x = 1 + random() % (kWidth - 3);
      const std::size_t y = 1 + random() % (kHeight - 3);
      // Eighths of a texel, as the sums count them.
      const float right = static_cast<float>(random() % 8) / 8;
      const float below = static_cast<float>(random() % 8) / 8;
      see(sums_, x, y, right, below, 1,
          static_cast<std::uint32_t>(std::lround(bilinear(truth_, x, y, right, below))));
    }
  }

  /// Root of the mean squared error of texels away from the border.
  [[nodiscard]] double error(const std::vector<float>& texture) const {
    double squared = 0;
    std::size_t count = 0;
    for (std::size_t y = 3; y + 3 < kHeight; ++y) {
      for (std::size_t x = 3; x + 3 < kWidth; ++x) {
        squared +=
            std::pow(static_cast<double>(texture[y * kWidth + x] - truth_[y * kWidth + x]), 2);
        ++count;
      }
    }
    return std::sqrt(squared / static_cast<double>(count));
  }

  std::vector<float> truth_;
  std::vector<TexelSums> sums_;
};

// The mean of what lies within a texel around is a blur; a few steps take most of it out.
TEST_F(Sharpening, ComesNearerToTheTruth) {
  Planes texture = mean_texture(sums_);
  const double before = error(texture[0]);
  solve_texture(sums_, kWidth, kNoMesh, kNoSurface, 1, texture);
  EXPECT_GT(before, 10);
  EXPECT_LT(error(texture[0]), 0.4 * before);
}

// The truth explains the pixels to their rounding, so it stays: each texel's equation is off by
// less than the mean rounding of its pixels, half a step.
TEST_F(Sharpening, LeavesTheTruthAlone) {
  Planes texture{truth_, truth_, truth_};
  solve_texture(sums_, kWidth, kNoMesh, kNoSurface, 1, texture);
  EXPECT_LT(error(texture[0]), 0.5);
}

TEST_F(Sharpening, ThreadsDoNotChangeABit) {
  Planes one = mean_texture(sums_);
  Planes many = one;
  solve_texture(sums_, kWidth, kNoMesh, kNoSurface, 1, one);
  solve_texture(sums_, kWidth, kNoMesh, kNoSurface, 5, many);
  EXPECT_EQ(one, many);
}

// A square of two triangles, a texel per 100th of its side, seen everywhere.
class SeenSquare : public ::testing::Test {
 protected:
  SeenSquare()
      : mesh_{.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
              .normals = std::vector<Eigen::Vector3f>(4, Eigen::Vector3f::UnitZ()),
              .triangles = {{0, 1, 2}, {0, 2, 3}}},
        atlas_(core::make_atlas(mesh_, 0.01f, 1 << 20)),
        surface_(atlas_),
        width_(static_cast<std::size_t>(atlas_.width)) {}

  /// Sums of pixels of these colours, one at every texel's centre that a reading touches.
  template <typename ColourOf>
  [[nodiscard]] std::vector<TexelSums> sums_of(const ColourOf& colour_of) const {
    std::vector<TexelSums> sums(atlas_.texel_count());
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      for (const SurfaceTexel& texel : surface_.of(t)) {
        const std::size_t x = texel.texel_idx % width_;
        const std::size_t y = texel.texel_idx / width_;
        const auto value = static_cast<std::uint32_t>(colour_of(x, y));
        see({sums.data(), width_}, {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f}, 1,
            value);
      }
    }
    return sums;
  }

  [[nodiscard]] Planes solved(const std::vector<TexelSums>& sums) const {
    Planes texture;
    for (auto& plane : texture) plane.assign(sums.size(), 100.0f);
    solve_texture(sums, width_, mesh_, surface_, 1, texture);
    return texture;
  }

  core::Mesh mesh_;
  core::Atlas atlas_;
  SurfaceTexels surface_;
  std::size_t width_;
};

// Shares of the corners add up to one, so each corner's mean is the constant and takes it off.
TEST_F(SeenSquare, LeavesToTheVerticesWhatIsTheSameEverywhere) {
  const auto sums = sums_of([](std::size_t, std::size_t) { return 120; });
  const Planes texture = solved(sums);
  for (const float texel : texture[1]) EXPECT_NEAR(texel, 100.0f, 1e-3f);
}

// A chequerboard's mean around any corner is zero, but for the edges: nothing is taken off, and
// pixels at centres meet texels only: t = (100 lambda + 100 +- 20) / (1 + lambda) with lambda 1.
TEST_F(SeenSquare, TakesWhatChangesBetweenVertices) {
  const auto sign = [](std::size_t x, std::size_t y) { return (x + y) % 2 == 0 ? 1 : -1; };
  const auto sums = sums_of([&](std::size_t x, std::size_t y) { return 100 + 20 * sign(x, y); });
  const Planes texture = solved(sums);
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (sums[i].weight == 0) continue;
    EXPECT_NEAR(texture[1][i], 100 + 10 * sign(i % width_, i / width_), 0.2);
  }
}

TEST(SolveTexture, LeavesTexelsWithoutPixels) {
  auto sums = empty_sums();
  see(sums, 5, 5, 0.5f, 0.5f, 1, 100);
  Planes texture = filled(70);
  solve_texture(sums, kWidth, kNoMesh, kNoSurface, 1, texture);
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (sums[i].weight == 0) {
      EXPECT_EQ(texture[0][i], 70.0f);
    } else {
      EXPECT_GT(texture[0][i], 70.0f);  // on the way to 100
    }
  }
}

TEST(SolveTexture, TakesTexturesWithoutInside) {
  std::vector<TexelSums> sums(2);
  Planes texture{std::vector<float>{1, 2}, std::vector<float>{1, 2}, std::vector<float>{1, 2}};
  solve_texture(sums, 2, kNoMesh, kNoSurface, 1, texture);
  EXPECT_EQ(texture[0], (std::vector<float>{1, 2}));
}

}  // namespace
}  // namespace sheen::fitting::detail
