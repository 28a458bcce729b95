// SPDX-License-Identifier: MIT
#include "core/atlas/atlas.h"

#include "core/atlas/atlas_vertices.h"
#include "core/atlas/packing.h"
#include "core/atlas/triangle_shapes.h"
#include "core/mesh/triangle_neighbours.h"
#include "tests/core/shapes.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace sheen::core {
namespace {

constexpr std::size_t kManyTexels = std::size_t{1} << 22;

struct Case {
  const char* name;
  Mesh mesh;
  float texel_m;
};

Mesh tetrahedron() {
  Mesh mesh;
  mesh.positions = {{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}};
  for (const auto& p : mesh.positions) mesh.normals.push_back(p.normalized());
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return mesh;
}

/// Triangles that share no vertex: every chart has one.
Mesh soup(std::size_t count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(-1, 1);
  Mesh mesh;
  for (std::uint32_t t = 0; t < count; ++t) {
    const Eigen::Vector3f centre(unit(random), unit(random), unit(random));
    for (int corner = 0; corner < 3; ++corner) {
      mesh.positions.push_back(centre +
                               0.1f * Eigen::Vector3f(unit(random), unit(random), unit(random)));
      mesh.normals.push_back(Eigen::Vector3f::UnitZ());
    }
    mesh.triangles.emplace_back(3 * t, 3 * t + 1, 3 * t + 2);
  }
  return mesh;
}

/// Two triangles without area among others.
Mesh with_needles() {
  Mesh mesh = testing::square_grid(3, 1, 0);
  mesh.positions.emplace_back(mesh.positions[0]);  // at vertex 0: a point beside it
  mesh.normals.emplace_back(Eigen::Vector3f::UnitZ());
  mesh.triangles.emplace_back(0u, 16u, 1u);
  mesh.triangles.emplace_back(0u, 1u, 2u);  // three in a row
  return mesh;
}

std::vector<Case> cases() {
  return {
      {"a plane", testing::square_grid(20, 1, 0), 0.01f},
      {"a sphere", testing::sphere(40, 80), 0.01f},
      {"a coarse sphere", testing::sphere(3, 4), 0.02f},
      {"a tetrahedron", tetrahedron(), 0.01f},
      {"two spheres", testing::together(testing::sphere(9, 18), testing::sphere(30, 60)), 0.01f},
      {"a soup", soup(300), 0.01f},
      {"needles", with_needles(), 0.01f},
      {"texels larger than triangles", testing::sphere(40, 80), 0.3f},
      {"one texel", tetrahedron(), 100.0f},
      {"nothing", {}, 0.01f}};
}

double area(const std::array<Eigen::Vector2f, 3>& corner) {
  const Eigen::Vector2d ab = (corner[1] - corner[0]).cast<double>();
  const Eigen::Vector2d ac = (corner[2] - corner[0]).cast<double>();
  return 0.5 * (ab.x() * ac.y() - ab.y() * ac.x());
}

std::array<Eigen::Vector2f, 3> flat(const Atlas& atlas, std::size_t t) {
  return {atlas.place(t, 0), atlas.place(t, 1), atlas.place(t, 2)};
}

TEST(MakeCharts, HoldEveryTriangleOnce) {
  for (const Case& one : cases()) {
    std::vector<int> times(one.mesh.triangles.size(), 0);
    for (const Chart& chart : make_charts(one.mesh, one.texel_m)) {
      EXPECT_EQ(chart.corners.size(), chart.triangles.size()) << one.name;
      EXPECT_TRUE(std::ranges::is_sorted(chart.triangles)) << one.name;
      for (const std::uint32_t t : chart.triangles) ++times[t];
    }
    EXPECT_TRUE(std::ranges::all_of(times, [](int n) { return n == 1; })) << one.name;
  }
}

// A point of the atlas that lies in two triangles would show one colour at two places. Corners are
// rounded to 1 / 65535 of the atlas' side, so points within that of a side belong to nobody.
TEST(MakeAtlas, NoTexelsCentreLiesInTwoTriangles) {
  for (const Case& one : cases()) {
    const Atlas atlas = make_atlas(one.mesh, one.texel_m, kManyTexels);
    const float rounding = 2.0f * static_cast<float>(std::max(atlas.width, atlas.height)) / 65535;
    std::vector<int> covered(atlas.texel_count(), 0);
    for (std::size_t t = 0; t < one.mesh.triangles.size(); ++t) {
      const auto corner = flat(atlas, t);
      Eigen::AlignedBox2f box;
      for (const Eigen::Vector2f& c : corner) box.extend(c);
      for (int y = static_cast<int>(box.min().y()); y <= static_cast<int>(box.max().y()); ++y) {
        for (int x = static_cast<int>(box.min().x()); x <= static_cast<int>(box.max().x()); ++x) {
          const Eigen::Vector2f centre(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
          bool inside = true;
          for (std::size_t i = 0; i < 3; ++i) {
            const Eigen::Vector2f along = corner[(i + 1) % 3] - corner[i];
            const Eigen::Vector2f inwards(-along.y(), along.x());
            inside = inside && along.norm() > 0.0f &&
                     inwards.dot(centre - corner[i]) / along.norm() > rounding;
          }
          covered[static_cast<std::size_t>(y * atlas.width + x)] += inside ? 1 : 0;
        }
      }
    }
    EXPECT_LE(covered.empty() ? 0 : *std::ranges::max_element(covered), 1) << one.name;
  }
}

// A reading at a corner touches the texels around it: they must be the chart's own.
TEST(MakeAtlas, ChartsLieInDisjointRectanglesWithinTheirGutters) {
  for (const Case& one : cases()) {
    const Atlas atlas = make_atlas(one.mesh, one.texel_m, kManyTexels);
    std::vector<int> owners(atlas.texel_count(), 0);
    for (const Atlas::Rectangle& chart : atlas.charts) {
      for (int y = chart.origin.y(); y < chart.origin.y() + chart.size.y(); ++y) {
        for (int x = chart.origin.x(); x < chart.origin.x() + chart.size.x(); ++x) {
          ++owners[static_cast<std::size_t>(y * atlas.width + x)];
        }
      }
    }
    EXPECT_LE(*std::ranges::max_element(owners), 1) << one.name;
    const float rounding = static_cast<float>(std::max(atlas.width, atlas.height)) / 65535;
    for (std::size_t t = 0; t < one.mesh.triangles.size(); ++t) {
      const auto corner = flat(atlas, t);
      const bool within = std::ranges::any_of(atlas.charts, [&](const Atlas::Rectangle& chart) {
        const Eigen::Array2f low = chart.origin.cast<float>().array() + kGutterTexels - rounding;
        const Eigen::Array2f high = (chart.origin + chart.size).cast<float>().array() -
                                    static_cast<float>(kGutterTexels) + rounding;
        return std::ranges::all_of(corner, [&](const Eigen::Vector2f& c) {
          return (c.array() >= low).all() && (c.array() <= high).all();
        });
      });
      EXPECT_TRUE(within) << one.name << ", triangle " << t;
    }
  }
}

// Orientation stays, and a triangle's area is that of the surface within the factor by which a
// slanted projection may shrink it (chart.h), as long as it is not a fraction of a texel.
TEST(MakeAtlas, AreasAreThoseOfTheSurface) {
  for (const Case& one : cases()) {
    const Atlas atlas = make_atlas(one.mesh, one.texel_m, kManyTexels);
    const TriangleShapes shapes = triangle_shapes(one.mesh);
    for (std::size_t t = 0; t < one.mesh.triangles.size(); ++t) {
      const double wanted =
          static_cast<double>(shapes.area_m2[t]) / static_cast<double>(one.texel_m * one.texel_m);
      if (wanted < 4) continue;
      const double found = area(flat(atlas, t));
      EXPECT_GT(found, 0.24 * wanted) << one.name << ", triangle " << t;
      EXPECT_LT(found, 4.1 * wanted) << one.name << ", triangle " << t;
    }
  }
}

// A plane is one chart without distortion, so a grid of 2 m has (2 / 0.01)^2 texels and a gutter.
TEST(MakeAtlas, APlaneIsOneChart) {
  const Atlas atlas = make_atlas(testing::square_grid(20, 1, 0), 0.01f, kManyTexels);
  ASSERT_EQ(atlas.charts.size(), 1u);
  EXPECT_NEAR(atlas.charts[0].size.x(), 200 + 2 * kGutterTexels, 1);
  EXPECT_NEAR(atlas.charts[0].size.y(), 200 + 2 * kGutterTexels, 1);
}

TEST(MakeAtlas, KeepsToItsMostTexels) {
  for (const std::size_t most : {std::size_t{5000}, std::size_t{100'000}}) {
    EXPECT_LE(make_atlas(testing::sphere(20, 40), 1e-4f, most).texel_count(), most);
  }
}

TEST(SplitAtSeams, IsUndoneByTheCorners) {
  for (const Case& one : cases()) {
    const Atlas atlas = make_atlas(one.mesh, one.texel_m, kManyTexels);
    const AtlasVertices split = split_at_seams(one.mesh, atlas);
    EXPECT_EQ(corners_of(split.place, split.triangles), atlas.corners) << one.name;
    ASSERT_EQ(split.triangles.size(), one.mesh.triangles.size()) << one.name;
    for (std::size_t t = 0; t < split.triangles.size(); ++t) {
      for (Eigen::Index corner = 0; corner < 3; ++corner) {
        EXPECT_EQ(split.vertex[split.triangles[t][corner]], one.mesh.triangles[t][corner]);
      }
    }
    for (std::uint32_t i = 0; i < one.mesh.positions.size(); ++i) EXPECT_EQ(split.vertex[i], i);
  }
}

TEST(TriangleNeighbours, AreMutualAndShareASide) {
  for (const Case& one : cases()) {
    const auto neighbours = triangle_neighbours(one.mesh);
    for (std::uint32_t t = 0; t < neighbours.size(); ++t) {
      for (const std::uint32_t other : neighbours[t]) {
        if (other == kNoTriangle) continue;
        EXPECT_NE(std::ranges::find(neighbours[other], t), neighbours[other].end()) << one.name;
      }
    }
  }
  // Of a tetrahedron each triangle has all others.
  for (const auto& sides : triangle_neighbours(tetrahedron())) {
    EXPECT_EQ(std::ranges::count(sides, kNoTriangle), 0);
  }
}

TEST(PackRectangles, AreDisjointAndFillMostOfTheirSquare) {
  std::mt19937 random(3);
  std::vector<Eigen::Vector2i> sizes;
  std::int64_t area = 0;
  for (int i = 0; i < 400; ++i) {
    sizes.emplace_back(1 + static_cast<int>(random() % 40), 1 + static_cast<int>(random() % 40));
    area += sizes.back().x() * sizes.back().y();
  }
  const Packing packing = pack_rectangles(sizes);
  std::vector<int> owners(static_cast<std::size_t>(packing.size.prod()), 0);
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    for (int y = 0; y < sizes[i].y(); ++y) {
      for (int x = 0; x < sizes[i].x(); ++x) {
        const Eigen::Vector2i at = packing.origins[i] + Eigen::Vector2i(x, y);
        ASSERT_TRUE((at.array() >= 0).all() && (at.array() < packing.size.array()).all());
        ++owners[static_cast<std::size_t>(at.y() * packing.size.x() + at.x())];
      }
    }
  }
  EXPECT_EQ(*std::ranges::max_element(owners), 1);
  EXPECT_GT(static_cast<double>(area) / packing.size.prod(), 0.8);
}

}  // namespace
}  // namespace sheen::core
