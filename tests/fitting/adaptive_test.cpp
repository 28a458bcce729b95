// SPDX-License-Identifier: MIT
#include "fitting/iwls/adaptive.h"

#include "tests/fitting/samples_for_tests.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace sheen::fitting::iwls {
namespace {

// The paper's rule with explicit lists, as section 3.3.1 describes it, and ours: no list falls
// below the three samples that a plane needs.
struct ListedCentre {
  Eigen::Vector2d position;
  std::size_t radius_idx = 0;
  std::vector<Sample> samples;

  void take(const Sample& sample, const std::vector<double>& radii) {
    if (!covers(sample, radii[radius_idx])) return;
    samples.push_back(sample);
    while (samples.size() > 12 && radius_idx + 1 < radii.size() &&
           std::count_if(samples.begin(), samples.end(),
                         [&](const Sample& s) { return covers(s, radii[radius_idx + 1]); }) >= 3) {
      ++radius_idx;
      std::erase_if(samples, [&](const Sample& s) { return !covers(s, radii[radius_idx]); });
    }
  }
  [[nodiscard]] bool covers(const Sample& s, double radius) const {
    return (Eigen::Vector2d(s.u, s.v) - position).norm() < radius;
  }
};

class AdaptiveLists : public ::testing::TestWithParam<Layout> {};

TEST_P(AdaptiveLists, RunningSumsEqualThem) {
  FitSettings settings;
  settings.layout = make_center_layout(GetParam(), 16);
  settings.rule.faithful = true;
  Adaptive<3> adaptive(settings, 1);
  LightFieldModel model({GetParam(), settings.layout.centers, 3, 0.7f}, 1);
  std::vector<ListedCentre> listed;
  for (const auto& c : settings.layout.centers) listed.push_back({c.cast<double>(), 0, {}});
  // Feed both, compare after every view.
  for (const auto& x : fitting::testing::scattered(150, 41)) {
    const Sample sample{x.x(), x.y(), {x.x() * x.y(), 0.5 + 0.2 * x.x(), x.y() * x.y()}};
    adaptive.integrate(0, sample, Rgb{}, model);
    for (std::size_t j = 0; j < listed.size(); ++j) {
      listed[j].take(sample, adaptive.radii());
      ASSERT_EQ(adaptive.radius_idx(0, j), listed[j].radius_idx);
      const auto& sums = adaptive.sums_of(0, j)[listed[j].radius_idx];
      ASSERT_EQ(sums.count, static_cast<double>(listed[j].samples.size()));
      NormalEquations<3> expected;
      const Node node{listed[j].position.x(), listed[j].position.y(),
                      adaptive.radii()[listed[j].radius_idx]};
      for (const Sample& s : listed[j].samples) add_if_covered(node, s, expected);
      // The same additions in the same order.
      ASSERT_EQ(sums.A, expected.A);
      ASSERT_EQ(sums.g, expected.g);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Layouts, AdaptiveLists,
                         ::testing::Values(Layout::grid, Layout::jittered_grid, Layout::disk,
                                           Layout::jittered_disk));

// sqrt 2 * 0.75^k >= spacing / sqrt 2: 0.75^k >= 1/4 for 16 centres (k <= 4), 1/8 for 64 (k <= 7).
TEST(Adaptive, RadiiShrinkByAQuarterDownToTheFloor) {
  for (const auto& [centers, count] : {std::pair{16, 5u}, std::pair{64, 8u}}) {
    FitSettings settings;
    settings.layout = make_center_layout(Layout::grid, centers);
    const Adaptive<1> adaptive(settings, 0);
    ASSERT_EQ(adaptive.radii().size(), count);
    EXPECT_DOUBLE_EQ(adaptive.radii()[0], kRootRadius);
    EXPECT_DOUBLE_EQ(adaptive.radii()[1], 0.75 * kRootRadius);
    EXPECT_GE(adaptive.radii().back(), spacing(settings.layout.side) / std::sqrt(2.0));
  }
}

}  // namespace
}  // namespace sheen::fitting::iwls
