// SPDX-License-Identifier: MIT
#include "fitting/iwls/solver.h"

#include "tests/fitting/samples_for_tests.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace sheen::fitting::iwls {
namespace {

const Node kNode{0.25, -0.25, 0.9};

Rgb wavy(double u, double v) {
  return {0.5 + 0.3 * std::sin(3 * u + v), 0.2 + 0.1 * u * v, 0.7 - 0.4 * v * v};
}

template <std::size_t kTerms>
NormalEquations<kTerms> sums_over(const std::vector<Eigen::Vector2d>& directions) {
  NormalEquations<kTerms> sums;
  for (const auto& x : directions) {
    add_if_covered(kNode, Sample{x.x(), x.y(), wavy(x.x(), x.y())}, sums);
  }
  return sums;
}

// Two implementations: running sums and L D L^T here, the stacked weighted system and a QR
// decomposition by Eigen there. Penalties enter the second one as extra rows sqrt(penalty).
template <std::size_t kTerms>
Eigen::MatrixXd by_qr(const std::vector<Eigen::Vector2d>& directions,
                      const Eigen::VectorXd& penalty, const Rgb& prior) {
  constexpr auto terms = static_cast<Eigen::Index>(kTerms);
  const auto count = static_cast<Eigen::Index>(directions.size());
  Eigen::MatrixXd B = Eigen::MatrixXd::Zero(count + terms, terms);
  Eigen::MatrixXd f = Eigen::MatrixXd::Zero(count + terms, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Vector2d& x = directions[static_cast<std::size_t>(i)];
    const double du = (x.x() - kNode.u) / kNode.radius;
    const double dv = (x.y() - kNode.v) / kNode.radius;
    const double root = std::sqrt(wendland(std::hypot(du, dv)));
    const auto b = basis<kTerms>(du, dv);
    const Rgb colour = wavy(x.x(), x.y());
    for (Eigen::Index k = 0; k < terms; ++k) B(i, k) = root * b[static_cast<std::size_t>(k)];
    for (Eigen::Index k = 0; k < 3; ++k) f(i, k) = root * colour[static_cast<std::size_t>(k)];
  }
  for (Eigen::Index k = 0; k < terms; ++k) B(count + k, k) = std::sqrt(penalty[k]);
  for (Eigen::Index k = 0; k < 3; ++k) {
    f(count, k) = std::sqrt(penalty[0]) * prior[static_cast<std::size_t>(k)];
  }
  return B.colPivHouseholderQr().solve(f);
}

template <std::size_t kTerms>
void expect_equal(const Polynomial<kTerms>& p, const Eigen::MatrixXd& expected, double tolerance) {
  for (std::size_t term = 0; term < kTerms; ++term) {
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(p[3 * term + i],
                  expected(static_cast<Eigen::Index>(term), static_cast<Eigen::Index>(i)),
                  tolerance);
    }
  }
}

TEST(Solver, EqualsDirectLeastSquares) {
  const auto directions = testing::scattered(60, 11);
  const Rgb prior{};
  FitRule rule;
  rule.faithful = true;
  expect_equal<3>(fit(sums_over<3>(directions), prior, rule),
                  by_qr<3>(directions, Eigen::VectorXd::Zero(3), prior), 1e-10);
  expect_equal<6>(fit(sums_over<6>(directions), prior, rule),
                  by_qr<6>(directions, Eigen::VectorXd::Zero(6), prior), 1e-9);
}

TEST(Solver, EqualsDirectRidgeRegression) {
  const auto directions = testing::scattered(60, 12);
  const Rgb prior{0.9, 0.1, 0.4};
  const FitRule rule;
  const auto sums = sums_over<6>(directions);
  Eigen::VectorXd penalty =
      Eigen::VectorXd::Constant(6, rule.ridge.relative * sums.weight() + rule.ridge.absolute);
  penalty[0] = rule.ridge.value;
  expect_equal<6>(fit(sums, prior, rule), by_qr<6>(directions, penalty, prior), 1e-9);
}

// A polynomial of the basis' degree is its own least-squares fit, whatever the weights.
TEST(Solver, ReproducesAQuadraticWithSixTerms) {
  const auto truth = [](double u, double v) -> Rgb {
    return {0.3 + 0.2 * u - 0.1 * v + 0.4 * u * u, 0.5 * u * v, 0.6 - 0.3 * v * v + 0.1 * u};
  };
  NormalEquations<6> sums;
  for (const auto& x : testing::scattered(40, 13)) {
    add_if_covered(kNode, Sample{x.x(), x.y(), truth(x.x(), x.y())}, sums);
  }
  FitRule rule;
  rule.faithful = true;
  const Polynomial<6> p = fit(sums, Rgb{}, rule);
  for (const auto& x : testing::scattered(40, 14)) {
    const Rgb value =
        value_at<6>(p, (x.x() - kNode.u) / kNode.radius, (x.y() - kNode.v) / kNode.radius);
    const Rgb expected = truth(x.x(), x.y());
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(value[i], expected[i], 1e-9);
  }
}

TEST(Solver, FaithfulFitOfALineFallsToTheWeightedMean) {
  NormalEquations<3> sums;
  FitRule rule;
  rule.faithful = true;
  double weight = 0, weighted = 0;
  for (int i = 0; i < 20; ++i) {
    const double t = -0.5 + 0.05 * i;
    const Sample sample{kNode.u + 0.8 * t, kNode.v + 0.6 * t, {t, 2 * t, 0.5}};
    add_if_covered(kNode, sample, sums);
    const double theta = wendland(std::abs(t) / kNode.radius);
    weight += theta;
    weighted += theta * t;
  }
  const Polynomial<3> p = fit(sums, Rgb{}, rule);
  EXPECT_NEAR(p[0], weighted / weight, 1e-12);
  EXPECT_NEAR(p[2], 0.5, 1e-12);
  for (std::size_t i = 3; i < 9; ++i) EXPECT_EQ(p[i], 0.0);
}

TEST(Solver, WithoutSamplesItAnswersWithThePrior) {
  for (const bool faithful : {false, true}) {
    FitRule rule;
    rule.faithful = faithful;
    const Polynomial<3> p = fit(NormalEquations<3>{}, Rgb{0.1, 0.2, 0.3}, rule);
    EXPECT_EQ(p, (Polynomial<3>{0.1, 0.2, 0.3, 0, 0, 0, 0, 0, 0}));
  }
}

// The order follows the count: 1 term below 3 samples, 3 below 6.
TEST(Solver, ChoosesNoMoreTermsThanSamplesCarry) {
  FitRule rule;
  rule.choose_order = true;
  const auto nonzero_terms = [&](std::size_t samples) {
    const Polynomial<6> p = fit(sums_over<6>({samples, {0.4, -0.1}}), Rgb{}, rule);
    int terms = 0;
    for (std::size_t term = 0; term < 6; ++term) terms += p[3 * term] != 0.0;
    return terms;
  };
  EXPECT_EQ(nonzero_terms(2), 1);
  EXPECT_EQ(nonzero_terms(3), 3);
  EXPECT_EQ(nonzero_terms(5), 3);
  EXPECT_EQ(nonzero_terms(6), 6);
}

TEST(Polynomial, ReExpansionIsTheSameFunction) {
  Polynomial<6> p;
  for (std::size_t i = 0; i < p.size(); ++i) p[i] = 0.1 * static_cast<double>(i) - 0.7;
  const double shift_x = 0.3, shift_y = -0.8, scale = 0.6;
  const Polynomial<6> q = re_expanded<6>(p, shift_x, shift_y, scale);
  for (const auto& x : testing::scattered(20, 15)) {
    const Rgb there = value_at<6>(q, x.x(), x.y());
    const Rgb here = value_at<6>(p, shift_x + scale * x.x(), shift_y + scale * x.y());
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(there[i], here[i], 1e-12);
  }
}

}  // namespace
}  // namespace sheen::fitting::iwls
