// SPDX-License-Identifier: MIT
#include "evaluation/study/random.h"

#include <gtest/gtest.h>

namespace sheen::evaluation {
namespace {

// The reference implementation's first outputs for state and increment set by hand: the generator's
// step is state * 6364136223846793005 + 1442695040888963407, and XSH-RR of state 0 is 0. After the
// constructor's step from key 0 the state is the increment c; its output by the definition:
// ((c >> 18) ^ c) >> 27 turned right by c >> 59.
TEST(Random, FollowsTheDefinitionOfPcg32) {
  constexpr std::uint64_t c = 1442695040888963407u;
  const auto shifted = static_cast<std::uint32_t>(((c >> 18) ^ c) >> 27);
  const unsigned turn = c >> 59;
  const std::uint32_t expected = turn == 0 ? shifted : (shifted >> turn) | (shifted << (32 - turn));
  EXPECT_EQ(Random(0).bits(), expected);
}

TEST(Random, UniformHasMeanAndVarianceOfTheUniformDistribution) {
  Random random(1);
  constexpr int count = 20000;
  double sum = 0;
  double squares = 0;
  for (int i = 0; i < count; ++i) {
    const auto value = static_cast<double>(random.uniform());
    ASSERT_GE(value, 0.0);
    ASSERT_LT(value, 1.0);
    sum += value;
    squares += value * value;
  }
  // Mean 1/2 with standard error sqrt(1/12 / 20000) = .002; second moment 1/3 with standard error
  // sqrt(4/45 / 20000) = .0021. Five of them.
  EXPECT_NEAR(sum / count, 0.5, 0.010);
  EXPECT_NEAR(squares / count, 1.0 / 3.0, 0.011);
}

TEST(Random, NormalHasUnitVariance) {
  Random random(2);
  constexpr int count = 20000;
  double sum = 0;
  double squares = 0;
  for (int i = 0; i < count; ++i) {
    const auto value = static_cast<double>(random.normal());
    sum += value;
    squares += value * value;
  }
  // Standard errors 1/sqrt(20000) = .0071 and sqrt(2/20000) = .01. Five of them.
  EXPECT_NEAR(sum / count, 0.0, 0.036);
  EXPECT_NEAR(squares / count, 1.0, 0.05);
}

// Archimedes: equal slices of height carry equal area, so z is uniform and its mean is the middle.
TEST(Random, SphereIsUniformInHeight) {
  Random random(3);
  constexpr int count = 20000;
  double sum = 0;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3f direction = random.on_sphere(0.2f, 1.0f);
    ASSERT_NEAR(direction.norm(), 1.0f, 1e-5f);
    sum += static_cast<double>(direction.z());
  }
  // Standard error .8 / sqrt(12 * 20000) = .0016.
  EXPECT_NEAR(sum / count, 0.6, 0.008);
}

TEST(Hash, DependsOnOrderAndLength) {
  EXPECT_NE(hash_of({1, 2}), hash_of({2, 1}));
  EXPECT_NE(hash_of({1}), hash_of({1, 0}));
  EXPECT_EQ(hash_of({1, 2}), hash_of({1, 2}));
}

}  // namespace
}  // namespace sheen::evaluation
