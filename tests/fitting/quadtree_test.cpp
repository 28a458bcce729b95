// SPDX-License-Identifier: MIT
#include "fitting/iwls/solver.h"
#include "tests/fitting/reference_quadtree.h"
#include "tests/fitting/samples_for_tests.h"

#include <gtest/gtest.h>

namespace sheen::fitting {
namespace {

using iwls::Construction;
using iwls::Layout;
using testing::make_iwls;
using testing::scattered;

Eigen::Vector3d rippled(double u, double v) {
  return {0.5 + 0.3 * std::sin(3 * u), 0.5 + 0.2 * std::cos(2 * v), 0.3 + 0.2 * u * v};
}

const iwls::LightFieldModel& model_of(const Fitter& fitter) {
  return dynamic_cast<const iwls::LightFieldModel&>(fitter.light_field());
}

std::vector<std::uint16_t> bits_of(const Fitter& fitter) {
  std::vector<std::uint16_t> bits;
  for (const Eigen::half value : model_of(fitter).coefficients()) bits.push_back(value.x);
  return bits;
}

// Two implementations: sums that run, four nodes side by side, in single precision with the ridge -
// and lists of samples, fitted anew by Eigen in double. Over scattered directions and along three
// arcs, while the tree grows. A value is the sum of at most six halves below 2, each off by 2^-11,
// averaged with weights; fits in single precision add less than a tenth of that.
TEST(Quadtree, EqualsListsOfSamplesFittedAnew) {
  for (const bool faithful : {false, true}) {
    for (const int terms : faithful ? std::vector<int>{3} : std::vector<int>{1, 3, 6}) {
      for (const int centers : {16, 64}) {
        for (const Layout layout : {Layout::grid, Layout::jittered_disk}) {
          const iwls::Options options{Construction::quadtree, layout, centers, terms, faithful};
          const auto tree = make_iwls(options);
          testing::ReferenceQuadtree reference(options);
          const auto directions = scattered(300, 34);
          for (std::size_t i = 0; i < directions.size(); ++i) {
            const auto& x = directions[i];
            tree->integrate(testing::one_sample(0, x, rippled(x.x(), x.y())));
            reference.add(x.cast<float>(), rippled(x.x(), x.y()).cast<float>());
            if (i != 0 && i != 2 && i != 20 && i != 80 && i + 1 != directions.size()) continue;
            tree->finish();
            reference.fit();
            for (const auto& at : testing::disc_grid(8, 16)) {
              const Eigen::Vector3f value = testing::colour_of(tree->light_field(), 0, at);
              const Eigen::Vector3d expected = reference.colour(at.cast<double>());
              const double scale = std::max(1.0, reference.largest_coefficient());
              EXPECT_LT((value.cast<double>() - expected).cwiseAbs().maxCoeff(), 1.6e-3 * scale)
                  << testing::text_of(options) << " after " << i + 1;
            }
          }
        }
      }
    }
  }
}

// Once every inner node holds more than 12 samples all leaves are finest: same nodes, same radius,
// same sums in the same order as batch. Without a ridge nothing else enters, so the bits are equal.
TEST(Quadtree, FullySplitEqualsBatch) {
  for (const Layout layout : testing::kLayouts) {
    for (const int centers : {16, 64}) {
      const auto tree = make_iwls({Construction::quadtree, layout, centers, 3, true});
      const auto batch = make_iwls({Construction::batch, layout, centers, 3, true});
      testing::teach(*tree, scattered(1000, 31), rippled);
      testing::teach(*batch, scattered(1000, 31), rippled);
      EXPECT_EQ(bits_of(*tree), bits_of(*batch));
    }
  }
}

// With 12 samples or fewer there is one leaf, the root: the field is one plane over the whole disc,
// the plain weighted fit about the origin.
TEST(Quadtree, UnsplitRootIsOnePlaneEverywhere) {
  const auto directions = scattered(12, 32);
  const auto tree = make_iwls({Construction::quadtree, Layout::grid, 16, 3, true});
  testing::teach(*tree, directions, rippled);
  iwls::NormalEquations<3> sums;
  const iwls::Node root{0, 0, std::sqrt(2.0)};
  for (const auto& x : directions) {
    const Eigen::Vector3d c = rippled(x.x(), x.y());
    add_if_covered(root, Sample{x.x(), x.y(), {c.x(), c.y(), c.z()}}, sums);
  }
  iwls::FitRule rule;
  rule.faithful = true;
  const auto plane = fit(sums, Rgb{}, rule);
  for (const auto& x : testing::disc_grid(6, 12)) {
    const Rgb expected = iwls::value_at<3>(plane, static_cast<double>(x.x()) / root.radius,
                                           static_cast<double>(x.y()) / root.radius);
    const Eigen::Vector3f value = testing::colour_of(tree->light_field(), 0, x);
    // Three halves below 2 in magnitude: 3 * 2^-11.
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(static_cast<double>(value[static_cast<Eigen::Index>(i)]), expected[i], 1.5e-3);
    }
  }
}

// One view more than the limit splits the root. A single root fit per view before: 12 fits; at the
// 13th the four children speak instead (empty ones, if any, cost nothing).
TEST(Quadtree, SplitsAboveFourTimesTheRank) {
  const auto directions = scattered(13, 33);
  const auto tree = make_iwls({Construction::quadtree, Layout::grid, 16, 3, true});
  for (std::size_t i = 0; i < 12; ++i) {
    tree->integrate(
        testing::one_sample(0, directions[i], rippled(directions[i].x(), directions[i].y())));
    EXPECT_EQ(tree->statistics().fits, i + 1);
  }
  tree->integrate(testing::one_sample(0, directions[12], rippled(0, 0)));
  EXPECT_EQ(tree->statistics().fits, 12u + 4u);
}

// Printed by the paper: about 1.7 fits per image for the hierarchical and 5.1 for the adaptive
// construction. Re-deriving both rules for scattered views (all covering leaves) gives 1.5 to 1.8
// at 20 views and 3.6 to 4.6 at 64 to 138 for the first, 4.0 to 7.3 there for the second.
TEST(Quadtree, CountsOfFitsAreThoseOfThePaper) {
  const auto fits_per_view = [](Construction construction, std::size_t views) {
    double sum = 0;
    for (unsigned seed = 0; seed < 20; ++seed) {
      const auto fitter = make_iwls({construction, Layout::grid, 16, 3, true});
      for (const auto& x : scattered(views, 300 + seed)) {
        fitter->integrate(testing::one_sample(0, x, rippled(x.x(), x.y())));
      }
      const FitStatistics statistics = fitter->statistics();
      EXPECT_EQ(statistics.patch_views, views);
      sum += static_cast<double>(statistics.fits) / static_cast<double>(views);
    }
    return sum / 20;
  };
  EXPECT_GT(fits_per_view(Construction::quadtree, 20), 1.4);
  EXPECT_LT(fits_per_view(Construction::quadtree, 20), 2.0);
  EXPECT_GT(fits_per_view(Construction::quadtree, 100), 3.4);
  EXPECT_LT(fits_per_view(Construction::quadtree, 100), 4.8);
  EXPECT_GT(fits_per_view(Construction::adaptive, 100), 4.0);
  EXPECT_LT(fits_per_view(Construction::adaptive, 100), 6.0);
}

}  // namespace
}  // namespace sheen::fitting
