// SPDX-License-Identifier: MIT
#include "core/visibility/ray_caster.h"
#include "fitting/guidance/candidate_views.h"
#include "fitting/guidance/capture_score.h"
#include "tests/core/shapes.h"
#include "tests/fitting/samples_for_tests.h"

#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <numeric>

namespace sheen::fitting::guidance {
namespace {

constexpr DirectionCells kAll = ~DirectionCells{0};

std::unique_ptr<PatchFitter> make(const std::string& name, std::size_t patches) {
  return make_isolated_patches(name, patches);
}

// All patches seen from one direction in one colour.
core::SampleBatch view(std::size_t patches, const Eigen::Vector2d& uv,
                       const Eigen::Vector3d& colour) {
  core::SampleBatch batch;
  for (std::uint32_t i = 0; i < patches; ++i) testing::add_sample(batch, i, uv, colour);
  return batch;
}

TEST(DirectionCells, CellOfItsCentreIsItself) {
  for (int cell = 0; cell < kCellCount; ++cell) EXPECT_EQ(cell_of(centre_of(cell)), cell);
}

TEST(DirectionCells, AnyDirectionHasACell) {
  const float infinity = std::numeric_limits<float>::infinity();
  for (const float value : {-infinity, -5.0f, -1.0f, 0.0f, 1.0f, 5.0f, infinity, std::nanf("")}) {
    for (const int cell : {cell_of({value, 0.0f}), cell_of({0.0f, value})}) {
      EXPECT_GE(cell, 0);
      EXPECT_LT(cell, kCellCount);
    }
  }
}

TEST(DirectionCells, DilationReachesTheCellsThatTouch) {
  for (int cell = 0; cell < kCellCount; ++cell) {
    DirectionCells expected = 0;
    for (int other = 0; other < kCellCount; ++other) {
      const int rows = std::abs(cell / kCellsPerSide - other / kCellsPerSide);
      const int columns = std::abs(cell % kCellsPerSide - other % kCellsPerSide);
      if (rows <= 1 && columns <= 1) expected |= cell_bit(other);
    }
    EXPECT_EQ(dilated(cell_bit(cell)), expected) << "cell " << cell;
  }
}

TEST(DirectionCells, VarianceFallsWithEveryCellSeen) {
  // Nothing seen: each of the 64 cells counts 1. All seen: 0. In between never rising, and one
  // more cell never gains more than it did with fewer seen (diminishing returns).
  EXPECT_FLOAT_EQ(variance_sum(0, kAll), 64);
  EXPECT_FLOAT_EQ(variance_sum(kAll, kAll), 0);
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const DirectionCells few = random() & random() & random();
    const DirectionCells more = few | (random() & random());
    const DirectionCells new_cell = cell_bit(static_cast<int>(random() % kCellCount));
    EXPECT_LE(variance_sum(more, kAll), variance_sum(few, kAll));
    const float gain_of_few = variance_sum(few, kAll) - variance_sum(few | new_cell, kAll);
    const float gain_of_more = variance_sum(more, kAll) - variance_sum(more | new_cell, kAll);
    EXPECT_GE(gain_of_few, 0);
    EXPECT_LE(gain_of_more, gain_of_few + 1e-4f);
  }
}

TEST(VertexAreas, AddUpToTheArea) {
  const core::Mesh square = core::testing::square_grid(7, 0.5f, 0.0f);  // side 1
  const auto area = vertex_areas(square);
  EXPECT_NEAR(std::accumulate(area.begin(), area.end(), 0.0), 1.0, 1e-5);
}

TEST(ViewUtility, PerfectPredictionsNeedNoViewsThere) {
  // A patch seen from one cell and predicted exactly there has familiar error 0, so the floor of
  // the camera's noise (.01 squared) is what remains.
  constexpr std::size_t patches = 3;
  const auto model = make("mean", patches);
  ViewUtility utility(patches);
  for (int i = 0; i < 100; ++i) {
    const auto batch = view(patches, {0.1, 0.1}, {0.5, 0.4, 0.3});
    utility.score(batch, model->light_field());
    utility.note(batch);
    model->integrate(batch);
  }
  EXPECT_LE(utility.seen_direction_error(0), 1.1e-4f);
  const DirectionCells seen = cell_bit(cell_of({0.1f, 0.1f}));
  EXPECT_EQ(utility.patches()[0].seen, seen);
  EXPECT_EQ(missing_variance(utility.patches()[0].seen, seen, utility.unseen_direction_error(0)),
            0);
  EXPECT_GT(missing_variance(utility.patches()[0].seen, kAll, utility.unseen_direction_error(0)),
            0);
}

TEST(ViewUtility, TellsMissingViewsFromAModelThatIsTooSimple) {
  // Patch 0 keeps its colour but is seen from one side only; patch 1 flickers between .2 and .8 and
  // is seen from all sides in turn. The first needs views; the second does not fit.
  const auto model = make("mean", 2);
  ViewUtility utility(2);
  DirectionCells swept = 0;
  for (int i = 0; i < 400; ++i) {
    core::SampleBatch batch;
    const Eigen::Vector2d side(-0.9 + 1.8 * (i % 40) / 39, 0);
    swept |= cell_bit(cell_of(side.cast<float>()));
    testing::add_sample(batch, 0, {0.1, 0}, {0.5, 0.5, 0.5});
    testing::add_sample(batch, 1, side, Eigen::Vector3d::Constant(i % 2 == 0 ? 0.2 : 0.8));
    utility.score(batch, model->light_field());
    utility.note(batch);
    model->integrate(batch);
  }
  EXPECT_GT(missing_variance(utility.patches()[0].seen, swept, utility.unseen_direction_error(0)),
            0);
  EXPECT_EQ(missing_variance(utility.patches()[1].seen, swept, utility.unseen_direction_error(1)),
            0);
  // The flicker is .3 either side of the mean: .09 squared. A steady patch is at the noise floor.
  EXPECT_NEAR(utility.seen_direction_error(1), 0.09f, 0.01f);
  EXPECT_LT(utility.seen_direction_error(0), 0.02f);
}

TEST(ViewUtility, IgnoresWhatIsNotANumber) {
  const auto model = make("mean", 1);
  ViewUtility utility(1);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& batch : {view(1, {0, 0}, {0.5, 0.5, 0.5}), view(1, {nan, 0}, {0.5, 0.5, 0.5}),
                            view(1, {0, 0}, {nan, 0.5, 0.5}), view(1, {0, 0}, {0.5, 0.5, 0.5})}) {
    const FrameScore score = utility.score(batch, model->light_field());
    EXPECT_TRUE(std::isfinite(score.squared_error) && std::isfinite(score.normalised_residual));
    utility.note(batch);
    model->integrate(batch);
  }
  EXPECT_EQ(utility.patches()[0].samples, 2u);
  EXPECT_TRUE(std::isfinite(utility.unseen_direction_error(0)) &&
              std::isfinite(utility.seen_direction_error(0)));
}

TEST(Coverage, GoesFromNothingToAll) {
  const std::vector<DirectionCells> reachable{kAll, disc_cells(), 0};
  const std::vector<float> area{1, 3, 100};  // the last has nothing to be seen from
  std::vector<PatchKnowledge> patches(3);
  EXPECT_EQ(coverage(patches, reachable, area), 0);
  patches[0].seen = kAll;
  EXPECT_DOUBLE_EQ(coverage(patches, reachable, area), 0.25);  // 1 of 1 + 3
  patches[1].seen = disc_cells();
  EXPECT_DOUBLE_EQ(coverage(patches, reachable, area), 1);
}

// Judges and integrates ordinary views until the gate has learnt what is usual.
class Gate : public ::testing::Test {
 protected:
  static constexpr std::size_t kPatches = 400;

  core::SampleBatch noisy_view(const Eigen::Vector2d& uv, double gain, double offset) {
    core::SampleBatch batch;
    for (std::uint32_t i = 0; i < kPatches; ++i) {
      const double colour = 0.3 + 0.3 * (i % 7) / 7.0;
      const double noise = 0.02 * (static_cast<double>(random_()) / 4294967296.0 - 0.5);
      // A wrong pose shows every patch the colour of another one.
      const double moved = offset * ((i * 37) % 11 < 5 ? 1 : -1);
      testing::add_sample(batch, i, uv, Eigen::Vector3d::Constant(gain * colour + noise + moved));
    }
    return batch;
  }
  FrameVerdict show(const core::SampleBatch& batch) {
    const FrameVerdict verdict = score_.judge(batch, model_->light_field());
    if (verdict == FrameVerdict::fine) {
      score_.note(batch, 0);
      model_->integrate(batch);
    }
    return verdict;
  }
  void learn() {
    for (int i = 0; i < 40; ++i) {
      ASSERT_EQ(show(noisy_view({0.1, 0.1}, 1, 0)), FrameVerdict::fine) << "view " << i;
    }
  }

  std::mt19937 random_{7};
  std::unique_ptr<PatchFitter> model_ = make("mean", kPatches);
  CaptureScore score_{kPatches};
};

TEST_F(Gate, RefusesAJumpOfTheExposureByItsName) {
  learn();
  EXPECT_EQ(show(noisy_view({0.1, 0.1}, 1.3, 0)), FrameVerdict::exposure_step);
  EXPECT_EQ(show(noisy_view({0.1, 0.1}, 0.75, 0)), FrameVerdict::exposure_step);
  EXPECT_EQ(show(noisy_view({0.1, 0.1}, 1, 0)), FrameVerdict::fine);
}

TEST_F(Gate, RefusesAWrongPose) {
  learn();
  EXPECT_EQ(show(noisy_view({0.1, 0.1}, 1, 0.15)), FrameVerdict::mismatch);
}

TEST_F(Gate, NoveltyIsNoFault) {
  // The same contradiction from where nobody has looked yet is news, not a fault.
  learn();
  EXPECT_EQ(show(noisy_view({-0.7, -0.3}, 1.3, 0.15)), FrameVerdict::fine);
}

TEST(QualityCurve, IsFlatOnlyOnceNothingRises) {
  QualityCurve curve;
  FrameScore score;
  score.predicted = 10;
  // From 20 dB upwards by .05 dB a frame: 4.5 dB over the window of 90 frames.
  for (int i = 0; i < 200; ++i) {
    score.squared_error = std::pow(10.0, -(20 + 0.05 * i) / 10);
    curve.add(score, 0.5);
    EXPECT_FALSE(curve.is_flat());
  }
  for (int i = 0; i < 200; ++i) curve.add(score, 0.5);
  EXPECT_TRUE(curve.is_flat());
  // Coverage that still rises is a reason to go on: 1.8 % over the window.
  for (int i = 0; i < 100; ++i) curve.add(score, 0.5 + 0.0002 * i);
  EXPECT_FALSE(curve.is_flat());
}

class CandidatesRoundASphere : public ::testing::Test {
 protected:
  CandidatesRoundASphere()
      : mesh_(core::testing::sphere(16, 32)),
        caster_(mesh_),
        views_(mesh_, caster_, {}, candidate_places({0, 0, 0}, 5, {0, 0, 1}, 48),
               [] { return false; }),
        area_(vertex_areas(mesh_)) {}

  // What a camera at a place sees of a matt sphere.
  core::SampleBatch seen_from(const Eigen::Vector3f& eye) const {
    core::SampleBatch batch;
    const auto frames = core::tangent_frames(mesh_);
    for (std::uint32_t i = 0; i < mesh_.positions.size(); ++i) {
      const auto direction = core::direction_towards(frames[i], mesh_.positions[i], eye);
      if (direction.cosine < 0.2f) continue;
      testing::add_sample(batch, i, direction.uv.cast<double>(), {0.5, 0.5, 0.5});
    }
    return batch;
  }

  core::Mesh mesh_;
  core::VertexNeighbours neighbours_ = core::vertex_neighbours(mesh_);
  core::RayCaster caster_;
  CandidateViews views_;
  std::vector<float> area_;
};

TEST_F(CandidatesRoundASphere, PlacesKeepTheirDistanceAboveTheBoard) {
  for (const Eigen::Vector3f& place : views_.places()) {
    EXPECT_NEAR(place.norm(), 5, 1e-4f);
    EXPECT_GT(place.z(), 0.4f);
  }
}

TEST_F(CandidatesRoundASphere, ThePlaceJustVisitedHasNothingMoreToOffer) {
  const auto model = make("mean", mesh_.positions.size());
  ViewUtility utility(mesh_.positions.size());
  const auto batch = seen_from(views_.places()[10]);
  utility.score(batch, model->light_field());
  utility.note(batch);
  const auto gains =
      views_.gains(utility.patches(), smooth_unseen_direction_errors(utility, neighbours_), area_);
  EXPECT_NEAR(gains[10], 0, 1e-12);
  EXPECT_GT(*std::max_element(gains.begin(), gains.end()), 0);
}

TEST_F(CandidatesRoundASphere, VisitingEveryPlaceCoversTheObject) {
  const auto model = make("mean", mesh_.positions.size());
  ViewUtility utility(mesh_.positions.size());
  double last = 0;
  for (const Eigen::Vector3f& place : views_.places()) {
    const auto batch = seen_from(place);
    utility.score(batch, model->light_field());
    utility.note(batch);
    model->integrate(batch);
    const double now = coverage(utility.patches(), views_.reachable(), area_);
    EXPECT_GE(now, last);
    last = now;
  }
  EXPECT_DOUBLE_EQ(last, 1);
  const auto gains =
      views_.gains(utility.patches(), smooth_unseen_direction_errors(utility, neighbours_), area_);
  EXPECT_FALSE(next_best_view(views_.places(), gains, {0, 0, 0}, {5, 0, 0}));
}

TEST(NextPlace, WeighsGainAgainstTheWay) {
  // Two places with equal gain: the nearer one. A farther one must offer more in proportion to the
  // way plus .2: here (1.571 + .2) / (.464 + .2) = 2.67 times.
  const std::vector<Eigen::Vector3f> places{{0, 1, 0}, {1, 0.5f, 0}};
  const Eigen::Vector3f eye(1, 0, 0);
  EXPECT_EQ(next_best_view(places, {1, 1}, {0, 0, 0}, eye), 1u);
  EXPECT_EQ(next_best_view(places, {2.6, 1}, {0, 0, 0}, eye), 1u);
  EXPECT_EQ(next_best_view(places, {2.8, 1}, {0, 0, 0}, eye), 0u);
}

}  // namespace
}  // namespace sheen::fitting::guidance
