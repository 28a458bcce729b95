// SPDX-License-Identifier: MIT
// Whether directions go to vertices or to anchors.
#include "fitting/detail/check_directions.h"
#include "fitting/detail/detail_light_field.h"
#include "tests/fitting/photographs_for_tests.h"
#include "tests/fitting/samples_for_tests.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

namespace sheen::fitting {
namespace {

using testing::Photographs;

/// A broad highlight on a smooth shape: neighbours mirror the same light.
Eigen::Vector3f glossy(const Eigen::Vector3f& p, const Eigen::Vector3f& towards_viewer) {
  const Eigen::Vector3f half = (towards_viewer + Eigen::Vector3f(0.3f, 0.2f, 0.93f)).normalized();
  const float highlight = std::pow(std::max(0.0f, p.normalized().dot(half)), 8.0f);
  return {0.3f + 0.4f * highlight, 0.3f + 0.4f * highlight, 0.2f};
}

/// Brighter from above and darker beside it, in stripes 120 mm wide: what two places 60 mm apart
/// say is opposite.
Eigen::Vector3f opposed(const Eigen::Vector3f& p, const Eigen::Vector3f& towards_viewer) {
  return Eigen::Vector3f::Constant(0.5f + 0.4f * std::sin(52.0f * p.x()) * towards_viewer.z());
}

Photographs of_sphere(const testing::Look& look, int views = 48) {
  return {render::testing::sphere(0.1f, 24), views, look};
}

/// Vertices lie 13 mm apart, the finer anchors `anchor_px` times 1.3 mm.
std::unique_ptr<Fitter> finished(const Photographs& photographs, const std::string& offsets,
                                 const std::string& anchor_px, int threads = 1) {
  auto fitter =
      make_fitter("detail", photographs.mesh(),
                  {{"texel-mm", "1.3"}, {"offsets", offsets}, {"anchor-px", anchor_px}}, threads);
  std::vector<int> order(photographs.views().size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  photographs.show(order, *fitter);
  fitter->finish();
  return fitter;
}

std::string bytes_of(const Fitter& fitter) {
  return testing::bytes_of(fitter.light_field());
}

// i + 2 j + 3 k changes by 1, 2 or 3 from a cell to one that shares a face, never by a multiple of
// 7; of seven cells in a row one is a check.
TEST(CheckDirections, LieApart) {
  const auto is_check = [](int i, int j, int k) {
    const Eigen::Vector3f cell(static_cast<float>(i), static_cast<float>(j), static_cast<float>(k));
    const Eigen::Vector3f middle = cell + Eigen::Vector3f::Constant(0.5f);
    return detail::is_check_direction(detail::kCheckCell * middle - Eigen::Vector3f::Ones());
  };
  for (int i = 0; i < 7; ++i) {
    for (int j = 0; j < 7; ++j) {
      int checks = 0;
      for (int k = 0; k < 7; ++k) {
        checks += is_check(i, j, k) ? 1 : 0;
        if (!is_check(i, j, k)) continue;
        EXPECT_FALSE(is_check(i + 1, j, k) || is_check(i, j + 1, k) || is_check(i, j, k + 1));
      }
      EXPECT_EQ(checks, 1) << i << " " << j;
    }
  }
}

// The model is the one that was chosen, to the bit.
TEST(ChoiceOfOffsets, FallsOnAnchorsWhereNeighboursAgree) {
  const Photographs photographs = of_sphere(glossy);
  const auto chosen = finished(photographs, "auto", "10");
  EXPECT_TRUE(chosen->statistics().choice.starts_with("directions at anchors"))
      << chosen->statistics().choice;
  EXPECT_EQ(bytes_of(*chosen), bytes_of(*finished(photographs, "anchors", "10")));
}

// Anchors 65 mm apart and more blend what cancels out.
TEST(ChoiceOfOffsets, FallsOnVerticesWhereNeighboursDisagree) {
  const Photographs photographs = of_sphere(opposed);
  const auto chosen = finished(photographs, "auto", "50");
  EXPECT_TRUE(chosen->statistics().choice.starts_with("directions at vertices: on directions"))
      << chosen->statistics().choice;
  EXPECT_EQ(bytes_of(*chosen), bytes_of(*finished(photographs, "vertex", "50")));
}

// What was seen once is a check or is fitted, and a check alone says nothing.
TEST(ChoiceOfOffsets, FallsOnVerticesWhereNothingCanBeChecked) {
  const Photographs photographs = of_sphere(glossy, 1);
  const auto chosen = finished(photographs, "auto", "10");
  EXPECT_EQ(chosen->statistics().choice, "directions at vertices: nothing to check the choice on");
  EXPECT_EQ(dynamic_cast<const detail::DetailLightField&>(chosen->light_field()).anchors(),
            nullptr);
}

TEST(ChoiceOfOffsets, IsThatOfAnyNumberOfThreads) {
  const Photographs photographs = of_sphere(glossy, 16);
  const auto one = finished(photographs, "auto", "10", 1);
  for (const int threads : {2, 8}) {
    const auto more = finished(photographs, "auto", "10", threads);
    EXPECT_EQ(one->statistics().choice, more->statistics().choice);
    EXPECT_EQ(bytes_of(*one), bytes_of(*more));
  }
}

}  // namespace
}  // namespace sheen::fitting
