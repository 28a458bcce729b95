// SPDX-License-Identifier: MIT
#include "evaluation/study/rank_correlation.h"

#include <gtest/gtest.h>

#include <array>

namespace sheen::evaluation {
namespace {

// Only the order counts: any rising function of the same values correlates fully.
TEST(Spearman, IsOneForTheSameOrderAndMinusOneForTheReverse) {
  const std::array<double, 4> a{0.1, 0.5, 0.2, 0.9};
  const std::array<double, 4> cubed{0.001, 0.125, 0.008, 0.729};
  const std::array<double, 4> negative{-0.1, -0.5, -0.2, -0.9};
  EXPECT_NEAR(spearman(a, cubed), 1.0, 1e-12);
  EXPECT_NEAR(spearman(a, negative), -1.0, 1e-12);
}

// Ranks 1 2 3 against 1.5 1.5 3: deviations -1 0 1 and -.5 -.5 1, covariance 1.5, variances 2 and
// 1.5: 1.5 / sqrt 3.
TEST(Spearman, TiesShareTheirRank) {
  const std::array<double, 3> a{1, 2, 3};
  const std::array<double, 3> tied{5, 5, 7};
  EXPECT_NEAR(spearman(a, tied), 0.8660254037844386, 1e-12);
}

TEST(Spearman, ConstantSideHasNoCorrelation) {
  const std::array<double, 3> a{1, 2, 3};
  const std::array<double, 3> constant{4, 4, 4};
  EXPECT_EQ(spearman(a, constant), 0.0);
  EXPECT_EQ(spearman({}, {}), 0.0);
}

// Positives score 3 and 1, others 2 and 0: of four pairs (3,2) (3,0) (1,0) are in order.
TEST(RankingQuality, CountsPairsInOrder) {
  const std::array<double, 4> scores{3, 1, 2, 0};
  const std::array<bool, 4> positive{true, true, false, false};
  EXPECT_NEAR(ranking_quality(scores, positive), 0.75, 1e-12);
}

TEST(RankingQuality, IsHalfWithoutInformation) {
  const std::array<double, 4> tied{1, 1, 1, 1};
  const std::array<bool, 4> positive{true, true, false, false};
  const std::array<bool, 4> all{true, true, true, true};
  EXPECT_NEAR(ranking_quality(tied, positive), 0.5, 1e-12);
  EXPECT_EQ(ranking_quality(tied, all), 0.5);
}

}  // namespace
}  // namespace sheen::evaluation
