// SPDX-License-Identifier: MIT
#include "fitting/unseen/fill_unseen.h"
#include "tests/fitting/samples_for_tests.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace sheen::fitting {
namespace {

// A path 0 - 1 - ... - (n - 1).
core::VertexNeighbours path(std::uint32_t count) {
  core::VertexNeighbours neighbours{{0}, {}};
  for (std::uint32_t i = 0; i < count; ++i) {
    if (i > 0) neighbours.indices.push_back(i - 1);
    if (i + 1 < count) neighbours.indices.push_back(i + 1);
    neighbours.offsets.push_back(static_cast<std::uint32_t>(neighbours.indices.size()));
  }
  return neighbours;
}

// Seen ends 0 and 1 of a path of seven: two rings carry each colour inwards, the middle is the
// mean.
TEST(FillUnseen, WalksRingByRing) {
  std::vector<Eigen::Vector3f> colours(7, Eigen::Vector3f::Constant(0.123f));
  colours.front() = Eigen::Vector3f::Zero();
  colours.back() = Eigen::Vector3f::Ones();
  fill_unseen(path(7), {1, 0, 0, 0, 0, 0, 1}, colours);
  const std::vector<float> expected{0, 0, 0, 0.5f, 1, 1, 1};
  for (std::size_t i = 0; i < 7; ++i) EXPECT_EQ(colours[i].x(), expected[i]);
}

TEST(FillUnseen, PartsWithoutASeenPatchGetTheMeanOfAll) {
  std::vector<Eigen::Vector3f> colours{Eigen::Vector3f::Zero(), Eigen::Vector3f::Ones(),
                                       Eigen::Vector3f::Constant(0.9f)};
  fill_unseen(testing::isolated(3), {1, 1, 0}, colours);
  EXPECT_EQ(colours[2], Eigen::Vector3f::Constant(0.5f));
}

TEST(FillUnseen, NothingSeenIsMidGrey) {
  std::vector<Eigen::Vector3f> colours(4, Eigen::Vector3f::Zero());
  fill_unseen(path(4), {0, 0, 0, 0}, colours);
  for (const auto& colour : colours) EXPECT_EQ(colour, Eigen::Vector3f::Constant(0.5f));
}

/// Two triangles with the edge 1 - 2 in common: from 0 to 3 it takes two steps.
core::Mesh strip() {
  core::Mesh mesh;
  mesh.positions = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}};
  mesh.normals.assign(4, Eigen::Vector3f::UnitZ());
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}};
  return mesh;
}

// A model's unseen patch takes its neighbour's mean colour, with the small weight, and gives it up
// when it is seen at last.
TEST(FillUnseen, FinishFillsAndLaterViewsReplace) {
  for (const std::string& name : testing::representation_names()) {
    SCOPED_TRACE(name);
    const auto fitter = testing::make_patches(name, strip());
    fitter->integrate(testing::one_sample(0, {0.2, 0.1}, {0.25, 0.5, 0.75}));
    const ModelUpdate& update = fitter->finish();
    EXPECT_TRUE(std::is_sorted(update.elements.begin(), update.elements.end()));
    const PatchLightField& model = fitter->light_field();
    EXPECT_EQ(model.observed(), (std::vector<std::uint8_t>{1, 0, 0, 0}));
    for (const std::size_t patch : {1, 2, 3}) {
      const WeightedColour filled = model.evaluate(patch, {0.0f, 0.0f});
      const WeightedColour seen = model.evaluate(0, {0.0f, 0.0f});
      EXPECT_LT((model.mean_colour(patch) - model.mean_colour(0)).norm(), 1e-3f);
      EXPECT_FLOAT_EQ(filled.weight_sum, seen.weight_sum * kUnseenWeight);
    }
    fitter->integrate(testing::one_sample(3, {0.2, 0.1}, {0.0, 1.0, 0.0}));
    fitter->finish();
    EXPECT_EQ(model.observed(), (std::vector<std::uint8_t>{1, 0, 0, 1}));
    EXPECT_LT((model.mean_colour(3) - Eigen::Vector3f(0, 1, 0)).norm(), 1e-3f);
    // Between a seen blue-grey and a seen green lies their mean.
    for (const std::size_t patch : {1, 2}) {
      EXPECT_LT((model.mean_colour(patch) - Eigen::Vector3f(0.125f, 0.75f, 0.375f)).norm(), 1e-3f);
    }
  }
}

}  // namespace
}  // namespace sheen::fitting
