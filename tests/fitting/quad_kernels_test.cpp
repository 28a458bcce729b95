// SPDX-License-Identifier: MIT
#include "fitting/iwls/quad_kernels.h"

#include "fitting/half.h"
#include "fitting/iwls/moment_rows.h"
#include "tests/fitting/samples_for_tests.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <limits>

namespace sheen::fitting::iwls {
namespace {

// One patch and the state of a fit of it.
template <typename Real>
struct OnePatch {
  QuadFit<Real> fit;
  std::vector<Real> moments;
  std::vector<std::uint8_t> flags;
  std::vector<std::uint16_t> coefficients;

  OnePatch(int centers, std::size_t rows, std::size_t terms, const FitRule& rule)
      : fit{QuadTree<Real>(make_center_layout(Layout::jittered_disk, centers), true), rule, 3},
        moments(fit.tree.quad_count * kLanes * rows),
        coefficients(fit.tree.finest_count() * kLanes * 3 * terms) {
    for (std::size_t quad = 0; quad < fit.tree.quad_count; ++quad) {
      flags.push_back(initial_flags(quad, fit.tree.first_finest));
    }
  }

  QuadPatch<Real> patch() { return {moments.data(), flags.data(), coefficients.data()}; }
};

template <typename Real, std::size_t kTerms>
OnePatch<Real> run(const QuadKernelSet<Real>& set, int centers, const FitRule& rule) {
  OnePatch<Real> state(centers, MomentRows<kTerms>::kRows, kTerms, rule);
  const double prior[3] = {0.4, 0.5, 0.6};
  for (const auto& x : testing::scattered(200, 41)) {
    const QuadSample sample{x.x(), x.y(), {0.5 + 0.4 * std::sin(5 * x.x()), x.y(), x.x() * x.y()}};
    set.of_terms(kTerms).integrate(state.fit, state.patch(), sample, prior);
  }
  set.of_terms(kTerms).solve(state.fit, state.patch(), prior);
  return state;
}

template <typename Real, std::size_t kTerms>
void expect_same_bits() {
  FitRule rule;
  rule.faithful = sizeof(Real) == 8;
  rule.choose_order = kTerms == 6;
  const auto& sets = quad_kernel_sets<Real>();
  for (const int centers : {16, 64}) {
    const auto expected = run<Real, kTerms>(sets.back(), centers, rule);
    for (const auto& set : sets) {
      const auto state = run<Real, kTerms>(set, centers, rule);
      EXPECT_EQ(state.coefficients, expected.coefficients) << set.instruction_set;
      EXPECT_EQ(state.flags, expected.flags) << set.instruction_set;
      EXPECT_EQ(std::memcmp(state.moments.data(), expected.moments.data(),
                            expected.moments.size() * sizeof(Real)),
                0)
          << set.instruction_set;
    }
  }
}

// A model must not depend on the machine that made it: no instruction set fuses or reorders.
TEST(QuadKernels, AllInstructionSetsGiveTheSameBits) {
  EXPECT_EQ(quad_kernel_sets<float>().back().instruction_set, "portable");
  expect_same_bits<float, 1>();
  expect_same_bits<float, 3>();
  expect_same_bits<float, 6>();
  expect_same_bits<double, 1>();
  expect_same_bits<double, 3>();
  expect_same_bits<double, 6>();
}

// A patch of one sample stores its prior-free value: with a faithful fit of one term the model is
// the sample's colour. So the kernels' rounding to half floats can be seen from outside: it must be
// that of Eigen for every number, subnormal and too large ones included.
TEST(QuadKernels, RoundToHalvesLikeEigen) {
  FitRule rule;
  rule.faithful = true;
  const double prior[3] = {0, 0, 0};
  std::mt19937 random(42);
  for (const auto& set : quad_kernel_sets<double>()) {
    for (int i = 0; i < 20000; ++i) {
      // Any float below 2^17 in size; every fourth one a tie between two halves.
      auto bits = static_cast<std::uint32_t>(random());
      bits = (bits & 0x807FFFFFU) | static_cast<std::uint32_t>(random() % 144) << 23;
      if (i % 4 == 0) bits = (bits & ~0x1FFFU) | 0x1000U;
      const double value = static_cast<double>(std::bit_cast<float>(bits));
      OnePatch<double> state(16, MomentRows<1>::kRows, 1, rule);
      set.one_term.integrate(state.fit, state.patch(), {0.1, 0.2, {value, value, value}}, prior);
      EXPECT_EQ(state.coefficients[0], stored_half(value).x) << value << set.instruction_set;
    }
  }
}

}  // namespace
}  // namespace sheen::fitting::iwls
