// SPDX-License-Identifier: MIT
#include "fitting/iwls/wendland.h"
#include "fitting/sparse/columns.h"
#include "fitting/sparse/patch_model.h"
#include "tests/fitting/samples_for_tests.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace sheen::fitting::sparse {
namespace {

using testing::scattered;

constexpr std::size_t kSamples = 43;  // not a multiple of the group: five rows of padding
constexpr std::size_t kRows = padded(kSamples);
static_assert(kRows == 48);

/// Scattered directions, far away behind the last.
struct Directions {
  Column u{}, v{};
  explicit Directions(unsigned seed) {
    const auto all = scattered(kSamples, seed);
    for (std::size_t row = 0; row < kRows; ++row) {
      u.row[row] = row < kSamples ? static_cast<float>(all[row].x()) : 8.0f;
      v.row[row] = row < kSamples ? static_cast<float>(all[row].y()) : 8.0f;
    }
  }
  [[nodiscard]] float distance(std::size_t a, std::size_t b) const {
    return std::hypot(u.row[a] - u.row[b], v.row[a] - v.row[b]);
  }
};

Column random_column(std::mt19937& random) {
  Column column{};
  for (std::size_t row = 0; row < kSamples; ++row) {
    column.row[row] = static_cast<float>(random()) / 4294967296.0f - 0.5f;
  }
  return column;
}

// 48 products of numbers below 1, summed in another order: 48 roundings of 2^-24, rounded up.
constexpr float kRounding = 1e-5f;

TEST(SparseColumns, WendlandIsTheFunctionOfTheDistance) {
  const Directions at(1);
  Column weight{};
  for (std::size_t row = 0; row < kSamples; ++row) weight.row[row] = 0.5f;
  Column rbf;
  columns::wendland(at.u, at.v, weight, kRows, 0.2f, -0.1f, 0.7f, rbf);
  for (std::size_t row = 0; row < kSamples; ++row) {
    const float distance = std::hypot(at.u.row[row] - 0.2f, at.v.row[row] + 0.1f) / 0.7f;
    EXPECT_NEAR(rbf.row[row], 0.5f * iwls::wendland(distance), kRounding);
  }
  // Nothing behind the last sample.
  for (std::size_t row = kSamples; row < kRows; ++row) EXPECT_EQ(rbf.row[row], 0.0f);
}

TEST(SparseColumns, KernelDensityCountsNeighboursAndItself) {
  for (const float reach : {0.001f, 0.1f, 0.6f}) {
    const Directions at(2);
    Column kernel_density;
    columns::kernel_density(at.u, at.v, kRows, reach, kernel_density);
    for (std::size_t i = 0; i < kSamples; ++i) {
      float expected = 0;
      for (std::size_t j = 0; j < kSamples; ++j) {
        expected += iwls::wendland(at.distance(i, j) / reach);
      }
      EXPECT_NEAR(kernel_density.row[i], expected, 3 * kRounding) << reach;
    }
  }
}

TEST(SparseColumns, ProductsAndDifferencesAreThoseOfPlainLoops) {
  constexpr unsigned seed = 3;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  std::array<Column, 7> all;  // one group of four and three more
  for (Column& column : all) column = random_column(random);
  const Column other = random_column(random);
  std::array<float, 7> products;
  columns::dots(all.data(), all.size(), other, kRows, products.data());
  Column rest = other;
  columns::subtract(all.data(), all.size(), products.data(), kRows, rest);
  Column lengths;
  columns::squared_lengths(all.data(), all.size(), kRows, lengths);
  for (std::size_t k = 0; k < all.size(); ++k) {
    float expected = 0;
    for (std::size_t row = 0; row < kSamples; ++row) expected += all[k].row[row] * other.row[row];
    EXPECT_NEAR(products[k], expected, kRounding);
    EXPECT_EQ(columns::dot(all[k], other, kRows), products[k]);
  }
  for (std::size_t row = 0; row < kSamples; ++row) {
    float left = other.row[row];
    float squared = 0;
    for (std::size_t k = 0; k < all.size(); ++k) {
      left -= products[k] * all[k].row[row];
      squared += all[k].row[row] * all[k].row[row];
    }
    EXPECT_NEAR(rest.row[row], left, kRounding);
    EXPECT_NEAR(lengths.row[row], squared, kRounding);
  }
}

// Numbers that are often equal, so that the first of several greatest has to be found; a third of
// the remainders say that there is nothing to gain.
/// Three atoms, two groups apart, and the lines that they have at scattered directions.
struct Lines {
  static constexpr std::array<std::size_t, 3> kAtoms{0, 17, kAtomPlaces - 1};
  Directions at{7};
  AtomPlaces places{};
  std::vector<AtomLine> line{kSamples};
  Lines() {
    std::fill_n(places.center_u.atom, kAtomPlaces, 8.0f);
    std::fill_n(places.per_squared_support.atom, kAtomPlaces, 1.0f);
    for (const std::size_t k : kAtoms) {
      places.center_u.atom[k] = 0.1f * static_cast<float>(k % 7) - 0.3f;
      places.center_v.atom[k] = 0.2f;
      places.per_squared_support.atom[k] = 1.0f / (0.7f * 0.7f);
    }
    columns::atom_lines(at.u, at.v, kSamples, places, kAtomPlaces, line.data());
  }
};

TEST(SparseColumns, AtomLinesHoldWhatColumnsHold) {
  const Lines lines;
  Column one{};
  for (std::size_t row = 0; row < kSamples; ++row) one.row[row] = 1.0f;
  for (const std::size_t k : Lines::kAtoms) {
    Column rbf;
    columns::wendland(lines.at.u, lines.at.v, one, kRows, lines.places.center_u.atom[k],
                      lines.places.center_v.atom[k], 0.7f, rbf);
    for (std::size_t row = 0; row < kSamples; ++row) {
      EXPECT_NEAR(lines.line[row].atom[k], rbf.row[row], kRounding);
    }
  }
  // Where there is no atom nothing is seen of it.
  for (const AtomLine& line : lines.line) EXPECT_EQ(line.atom[1], 0.0f);
}

TEST(SparseColumns, SumsOverAtomLinesAreThoseOfPlainLoops) {
  const Lines lines;
  std::mt19937 random(8);
  const std::array<Column, 3> factor{random_column(random), random_column(random),
                                     random_column(random)};
  std::array<AtomLine, 3> sum;
  AtomLine covered;
  AtomLine squared;
  columns::atom_sums(lines.line.data(), kSamples, kAtomPlaces, factor.data(), sum.data());
  columns::atom_squares(lines.line.data(), kSamples, kAtomPlaces, factor[0], covered, squared);
  AtomLine remainder{};
  std::array<AtomLine, 3> correlation{};
  const std::array<float, 3> along{1.0f, -2.0f, 0.5f};
  columns::take_away(lines.line.data(), kSamples, kAtomPlaces, factor.data(), along.data(), 1,
                     remainder, correlation.data());
  for (const std::size_t k : Lines::kAtoms) {
    std::array<float, 3> expected{};
    float expected_squared = 0;
    for (std::size_t row = 0; row < kSamples; ++row) {
      const float value = lines.line[row].atom[k];
      for (std::size_t c = 0; c < 3; ++c) expected[c] += factor[c].row[row] * value;
      expected_squared += factor[0].row[row] * value * value;
    }
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(sum[c].atom[k], expected[c], kRounding);
      EXPECT_NEAR(correlation[c].atom[k], -along[c] * expected[0], 2 * kRounding);
    }
    EXPECT_NEAR(covered.atom[k], expected[0], kRounding);
    EXPECT_NEAR(squared.atom[k], expected_squared, kRounding);
    EXPECT_NEAR(remainder.atom[k], -expected[0] * expected[0], 10 * kRounding);
  }
}

TEST(SparseColumns, SeveralColumnsTakeAwayWhatEachDoes) {
  // The same sums in the same order: equal to the bit.
  const Lines lines;
  std::mt19937 random(9);
  const std::array<Column, 3> factor{random_column(random), random_column(random),
                                     random_column(random)};
  const std::array<float, 9> along{1.0f, -2.0f, 0.5f, 0.1f, 3.0f, -1.0f, 0.7f, 0.2f, -0.4f};
  AtomLine together{}, apart{};
  std::array<AtomLine, 3> correlations{}, correlations_apart{};
  columns::take_away(lines.line.data(), kSamples, kAtomPlaces, factor.data(), along.data(), 3,
                     together, correlations.data());
  for (std::size_t j = 0; j < factor.size(); ++j) {
    columns::take_away(lines.line.data(), kSamples, kAtomPlaces, &factor[j], &along[3 * j], 1,
                       apart, correlations_apart.data());
  }
  for (const std::size_t k : Lines::kAtoms) {
    EXPECT_EQ(together.atom[k], apart.atom[k]);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(correlations[c].atom[k], correlations_apart[c].atom[k]);
    }
  }
}

TEST(SparseColumns, AtomsFeltSomewhereAreListed) {
  // A squared length of .02 over 128 samples of weight 1 needs one of sqrt(.02 / 128) = .0125.
  for (const Eigen::Vector2f& uv : testing::disc_grid()) {
    const AtomSet& felt = atoms_felt_at(uv);
    std::size_t count = 0;
    for (std::size_t id = 0; id < atoms().size(); ++id) {
      const Atom& atom = atoms()[id];
      const bool is_listed = (felt[id / 64] >> id % 64 & 1) != 0;
      count += is_listed ? 1 : 0;
      if (iwls::wendland((uv - atom.center).norm() / atom.support) >= 0.0125f) {
        EXPECT_TRUE(is_listed) << id;
      }
    }
    EXPECT_LT(count, atoms().size());
  }
}

TEST(SparseColumns, TheBestGainIsTheFirstOfTheGreatest) {
  constexpr std::size_t count = 40;
  constexpr float least = 0.5f;
  std::mt19937 random(4);
  for (int round = 0; round < 200; ++round) {
    Column r{}, g{}, b{}, remainder{};
    std::size_t expected = count;
    float greatest = 0;
    for (std::size_t k = 0; k < count; ++k) {
      for (Column* const column : {&r, &g, &b}) {
        column->row[k] = static_cast<float>(random() % 5) - 2.0f;
      }
      remainder.row[k] = 0.5f * static_cast<float>(random() % 3);
      if (!(remainder.row[k] > least)) continue;
      const float gain =
          (r.row[k] * r.row[k] + g.row[k] * g.row[k] + b.row[k] * b.row[k]) / remainder.row[k];
      if (!(gain > greatest)) continue;
      greatest = gain;
      expected = k;
    }
    EXPECT_EQ(columns::best_gain(r.row, g.row, b.row, remainder.row, count, least), expected);
  }
  const Column nothing{};
  EXPECT_EQ(columns::best_gain(nothing.row, nothing.row, nothing.row, nothing.row, count, least),
            count);
}

}  // namespace
}  // namespace sheen::fitting::sparse
