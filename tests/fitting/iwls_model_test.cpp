// SPDX-License-Identifier: MIT
#include "fitting/iwls/light_field_model.h"
#include "fitting/iwls/polynomial.h"
#include "fitting/iwls/wendland.h"
#include "tests/fitting/samples_for_tests.h"

#include <gtest/gtest.h>

namespace sheen::fitting::iwls {
namespace {

constexpr std::size_t kPatches = 3;

ModelShape shape_of(std::size_t centers, int terms) {
  ModelShape shape{Layout::disk, {}, terms, 0.9f};
  for (const auto& x : testing::scattered(centers, 81)) shape.centers.push_back(x.cast<float>());
  return shape;
}

std::vector<Eigen::half> random_coefficients(const ModelShape& shape) {
  std::mt19937 random(82);
  std::vector<Eigen::half> coefficients;
  const std::size_t count =
      kPatches * shape.centers.size() * static_cast<std::size_t>(3 * shape.terms);
  for (std::size_t i = 0; i < count; ++i) {
    coefficients.emplace_back(static_cast<float>(random() % 2048) / 2048.0f - 0.5f);
  }
  return coefficients;
}

// Centres stand in other places in memory than in files; a number of centres that fills no quad
// leaves gaps. Nothing of that shows outside.
TEST(IwlsModel, CoefficientsComeBackInTheOrderOfTheFile) {
  for (const std::size_t centers : {1u, 5u, 16u, 64u}) {
    for (const int terms : {1, 3, 6}) {
      const ModelShape shape = shape_of(centers, terms);
      const auto given = random_coefficients(shape);
      const LightFieldModel model(shape, given, {1, 0, 1});
      EXPECT_EQ(model.coefficients_by_center(), given);
      EXPECT_EQ(model.coefficient_count(), given.size());
    }
  }
}

// Two implementations: four centres at a time in single precision, and eq. 7 written out in double.
// Colours are sums of at most 64 x 6 terms below 1/2 with weights below 1: relative rounding of
// 2^-24 each, far below 1e-5 of the weight sum.
TEST(IwlsModel, EvaluatesThePartitionOfUnity) {
  for (const std::size_t centers : {1u, 5u, 16u, 64u}) {
    const ModelShape shape = shape_of(centers, 6);
    const auto coefficients = random_coefficients(shape);
    const LightFieldModel model(shape, coefficients, {1, 0, 1});
    for (const auto& x : testing::disc_grid(6, 12)) {
      Rgb sum{};
      double weight = 0;
      for (std::size_t j = 0; j < centers; ++j) {
        const Eigen::Vector2d e =
            (x - shape.centers[j]).cast<double>() / double{shape.support_radius};
        const double theta = wendland(e.norm());
        Polynomial<6> polynomial;
        for (std::size_t i = 0; i < 18; ++i) {
          polynomial[i] = static_cast<double>(static_cast<float>(coefficients[18 * j + i]));
        }
        const Rgb value = value_at<6>(polynomial, e.x(), e.y());
        for (std::size_t i = 0; i < 3; ++i) sum[i] += theta * value[i];
        weight += theta;
      }
      const WeightedColour result = model.evaluate(0, x);
      EXPECT_NEAR(result.weight_sum, weight, 1e-5 * (1 + weight));
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(result.colour_sum[static_cast<Eigen::Index>(i)], sum[i], 1e-5 * (1 + weight));
      }
      // A patch nobody saw counts for a thousandth.
      EXPECT_LE(model.evaluate(1, x).weight_sum, kUnseenWeight * result.weight_sum + 1e-9f);
    }
  }
}

}  // namespace
}  // namespace sheen::fitting::iwls
