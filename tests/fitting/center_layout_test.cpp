// SPDX-License-Identifier: MIT
#include "fitting/iwls/center_layout.h"

#include "core/geometry/disc_map.h"
#include "fitting/iwls/quad_tree.h"
#include "fitting/iwls/slots.h"
#include "fitting/iwls/wendland.h"
#include "tests/fitting/samples_for_tests.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace sheen::fitting::iwls {
namespace {

TEST(Wendland, HasItsClosedFormValues) {
  EXPECT_EQ(wendland(0.0), 1.0);
  EXPECT_EQ(wendland(1.0), 0.0);
  EXPECT_EQ(wendland(2.0), 0.0);
  // (1/2)^4 (4/2 + 1) = 3/16.
  EXPECT_DOUBLE_EQ(wendland(0.5), 3.0 / 16.0);
}

// theta'(d) = -20 d (1 - d)^3: zero at the centre and at the rim, where theta'' vanishes too.
TEST(Wendland, IsFlatAtCentreAndRim) {
  const double e = 1e-4;
  for (double d = 0.1; d < 0.95; d += 0.1) {
    const double slope = (wendland(d + e) - wendland(d - e)) / (2 * e);
    EXPECT_NEAR(slope, -20 * d * std::pow(1 - d, 3), 1e-6);
  }
  // 1 - theta(e) = 10 e^2 to first order; theta(1 - e) = 5 e^4 to first order.
  EXPECT_NEAR((1.0 - wendland(e)) / (e * e), 10.0, 0.01);
  EXPECT_NEAR(wendland(1.0 - 1e-2) / 1e-8, 5.0, 0.05);
}

TEST(CenterLayout, GridHoldsTheCellCentres) {
  const CenterLayout layout = make_center_layout(Layout::grid, 16);
  ASSERT_EQ(layout.centers.size(), 16u);
  EXPECT_TRUE(layout.centers[0].isApprox(Eigen::Vector2f(-0.75f, -0.75f)));
  EXPECT_TRUE(layout.centers[1].isApprox(Eigen::Vector2f(-0.25f, -0.75f)));
  EXPECT_TRUE(layout.centers[15].isApprox(Eigen::Vector2f(0.75f, 0.75f)));
}

// The paper's grid wastes 4 of 16 and 12 of 64 centres outside the disc, the disk layouts none.
TEST(CenterLayout, CountsCentresOutsideTheDisc) {
  const auto outside = [](Layout layout, int centers) {
    int count = 0;
    for (const auto& c : make_center_layout(layout, centers).centers) count += c.norm() > 1.0f;
    return count;
  };
  EXPECT_EQ(outside(Layout::grid, 16), 4);
  EXPECT_EQ(outside(Layout::grid, 64), 12);
  for (const Layout layout : {Layout::disk, Layout::jittered_disk}) {
    EXPECT_EQ(outside(layout, 16), 0);
    EXPECT_EQ(outside(layout, 64), 0);
  }
}

TEST(CenterLayout, JitterStaysInItsCellAndMoves) {
  for (const int centers : {16, 64}) {
    for (const Layout layout : {Layout::jittered_grid, Layout::jittered_disk}) {
      const CenterLayout jittered = make_center_layout(layout, centers);
      const CenterLayout regular = make_center_layout(Layout::grid, centers);
      const float half_cell = static_cast<float>(spacing(regular.side)) / 2;
      for (std::size_t i = 0; i < jittered.centers.size(); ++i) {
        const Eigen::Vector2f square = layout == Layout::jittered_disk
                                           ? core::square_from_disc(jittered.centers[i])
                                           : jittered.centers[i];
        const float moved = (square - regular.centers[i]).cwiseAbs().maxCoeff();
        EXPECT_LE(moved, half_cell + 1e-5f);
        EXPECT_GT(moved, 0.0f);
      }
    }
  }
}

// Every closed disc must lie in the union of the supports, or the partition of unity is 0 / 0. The
// worst point of any layout stays farther from the supports' rim than 2 % of the radius, beyond
// what the grid of 1/200 can miss.
TEST(CenterLayout, SupportsCoverTheClosedDisc) {
  for (const Layout layout : testing::kLayouts) {
    for (const int centers : {16, 64}) {
      const CenterLayout result = make_center_layout(layout, centers);
      const double radius = level_radius(result.side);
      double worst = 0;
      for (const Eigen::Vector2f& x : testing::disc_grid(200, 400)) {
        double nearest = 1e9;
        for (const auto& c : result.centers) {
          nearest = std::min(nearest, static_cast<double>((x - c).norm()));
        }
        worst = std::max(worst, nearest);
      }
      EXPECT_LT(worst, 0.98 * radius) << name_of(layout) << " " << centers;
    }
  }
}

// Constants at all centres blend to the constant exactly when the normalised weights sum to one.
TEST(PartitionOfUnity, WeightsSumToOne) {
  for (const Layout layout : testing::kLayouts) {
    for (const int centers : {16, 64}) {
      const CenterLayout centres = make_center_layout(layout, centers);
      LightFieldModel model(
          {layout, centres.centers, 1, static_cast<float>(level_radius(centres.side))}, 1);
      model.store_constant(0, Eigen::Vector3f::Ones());
      model.store_observed(0, true);
      for (const Eigen::Vector2f& x : testing::disc_grid()) {
        const WeightedColour sum = model.evaluate(0, x);
        ASSERT_GT(sum.weight_sum, 0.0f);
        EXPECT_NEAR(sum.colour_sum.x() / sum.weight_sum, 1.0f, 1e-6f);
      }
    }
  }
}

TEST(PartitionOfUnity, DirectionsBeyondTheRimCountAsRim) {
  const CenterLayout centres = make_center_layout(Layout::disk, 16);
  LightFieldModel model({Layout::disk, centres.centers, 1, 0.7f}, 1);
  const WeightedColour rim = model.evaluate(0, {0.6f, 0.8f});
  const WeightedColour beyond = model.evaluate(0, {0.66f, 0.88f});
  EXPECT_NEAR(beyond.weight_sum, rim.weight_sum, 1e-6f * rim.weight_sum);
}

// Radii halve their area per level (eq. 9): sqrt 2, 1, 1 / sqrt 2, 1 / 2. Children stand at the
// corners of a square of half their parent's cell, two by two in each axis.
TEST(QuadTree, HasThePapersRadiiAndNestedCells) {
  const QuadTree<double> tree(make_center_layout(Layout::grid, 64), true);
  ASSERT_EQ(tree.quad_count, 1u + 1u + 4u + 16u);
  EXPECT_EQ(tree.first_finest, 6u);
  EXPECT_DOUBLE_EQ(tree.quads[0].radius, std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(tree.quads[1].radius, 1.0);
  EXPECT_DOUBLE_EQ(tree.quads[2].radius, std::sqrt(0.5));
  EXPECT_DOUBLE_EQ(tree.quads[6].radius, 0.5);
  for (std::size_t quad = 0; quad < tree.first_finest; ++quad) {
    const double half_cell = quad == 0 ? 0.5 : (quad == 1 ? 0.25 : 0.125);
    for (std::size_t lane = 0; lane < (quad == 0 ? 1u : kLanes); ++lane) {
      const Quad<double>& below = tree.quads[quad == 0 ? 1 : 4 * (quad - 1) + lane + 2];
      for (std::size_t i = 0; i < kLanes; ++i) {
        EXPECT_NEAR(below.u[i] - tree.quads[quad].u[lane], i % 2 == 0 ? -half_cell : half_cell,
                    1e-6);
        EXPECT_NEAR(below.v[i] - tree.quads[quad].v[lane], i / 2 == 0 ? -half_cell : half_cell,
                    1e-6);
      }
    }
  }
}

// Every centre has a slot of its own; siblings share a quad.
TEST(Slots, AreAPermutationThatKeepsSiblingsTogether) {
  for (const std::size_t count : {1u, 5u, 16u, 17u, 64u}) {
    std::vector<std::size_t> sorted = slots_of_centers(count);
    std::ranges::sort(sorted);
    for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(sorted[i], i);
  }
  // The 4 x 4 grid row by row: two quads above two.
  const std::vector<std::size_t> expected{0, 1, 4, 5, 2, 3, 6, 7, 8, 9, 12, 13, 10, 11, 14, 15};
  EXPECT_EQ(slots_of_centers(16), expected);
}

}  // namespace
}  // namespace sheen::fitting::iwls
