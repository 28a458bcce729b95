// SPDX-License-Identifier: MIT
#include "evaluation/paper/incremental.h"
#include "evaluation/paper/layouts.h"
#include "evaluation/scene/scene_study.h"
#include "evaluation/stability/stability_suite.h"
#include "evaluation/stability/stability_tables.h"
#include "evaluation/study/measure.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sheen::evaluation {
namespace {

using fitting::iwls::Construction;

void ignore(const std::string&) {}

Measurement measured(const Method& method, MaterialClass material, ViewSet views,
                     std::size_t samples, const Corruption& corruption = {}) {
  TestBedOptions options;
  options.materials = {material};
  options.points_per_material = 6;
  options.views = views;
  options.training_views = samples;
  options.corruption = corruption;
  return measure(method, make_test_bed(options, studio_environment()));
}

// A light field of one colour that is known.
class Grey final : public fitting::PatchLightField {
 public:
  explicit Grey(float value) : value_(value) {}
  std::string_view representation() const override { return "grey"; }
  std::size_t patch_count() const override { return 1; }
  fitting::WeightedColour evaluate(std::size_t, const Eigen::Vector2f&) const override {
    return {Eigen::Vector3f::Constant(2 * value_), 2.0f};
  }
  Eigen::Vector3f mean_colour(std::size_t) const override {
    return Eigen::Vector3f::Constant(value_);
  }
  const std::vector<std::uint8_t>& observed() const override { return observed_; }
  std::size_t coefficient_count() const override { return 3; }

 private:
  float value_;
  std::vector<std::uint8_t> observed_{1};
};

// 1.5 is shown as 1: errors of 0 and .5 give an RMS of sqrt(.125) and, before the clamp, a worst
// error of 1.
TEST(Measure, ClampsForTheRmsAndNotForTheWorst) {
  const std::vector<TestSample> test{{{0, 0}, Eigen::Vector3f::Constant(1.0f), false},
                                     {{0, 0}, Eigen::Vector3f::Constant(0.5f), true}};
  const PointError error = point_error(Grey(1.5f), 0, test);
  EXPECT_NEAR(error.rms, std::sqrt(0.125), 1e-6);
  EXPECT_NEAR(error.worst, 1.0, 1e-6);
  EXPECT_NEAR(error.rms_in_gap, 0.5, 1e-6);
}

// One colour is the whole truth of a Lambert patch: the mean of n samples with noise s, rounded to
// 1/255, is off by sqrt((s^2 + (1/255)^2 / 12) / n) = .00126 with s = .01 and n = 64; the half
// float adds up to 2^-12 = .00024. Six patches with three channels: within half.
TEST(Measure, MeanColourOfLambertIsAsGoodAsTheNoiseAllows) {
  const Measurement mean = measured({"mean", "mean", {}}, MaterialClass::lambert, ViewSet::uni, 64);
  EXPECT_LT(mean.mean_rms(), 1.5 * 0.00126);
  EXPECT_EQ(mean.coefficients_per_point, 3.0);
}

// Without noise and pose error a constant is in the span of every model: what is left is rounding
// to 8 bits (at most .5 / 255 for the mean of equal values) and to half floats.
TEST(Measure, EveryMethodReproducesAConstant) {
  const Corruption clean{.noise = 0.0f, .pose_error = 0.0f};
  for (const Method& method : all_methods()) {
    const Measurement result = measured(method, MaterialClass::lambert, ViewSet::uni, 64, clean);
    EXPECT_LT(result.mean_rms(), 0.5 / 255 + 0.001) << method.name;
  }
}

// Where there is something to see from 128 scattered views, any directional model beats one colour.
TEST(Measure, QuadtreeBeatsTheMeanOnGlossyPatches) {
  for (const bool faithful : {true, false}) {
    const Method method = iwls_method(Construction::quadtree, faithful);
    for (const MaterialClass material : {MaterialClass::ggx60, MaterialClass::ggx25}) {
      const double quadtree = measured(method, material, ViewSet::uni, 128).mean_rms();
      const double mean = measured({"mean", "mean", {}}, material, ViewSet::uni, 128).mean_rms();
      EXPECT_LT(quadtree, 0.5 * mean) << method.name << ", " << name_of(material);
    }
  }
}

// The ridge exists for sweeps: with one arc the unregularised plane is free across it.
TEST(Measure, RidgeBoundsWhatAnArcLeavesOpen) {
  const double faithful = measured(iwls_method(Construction::quadtree, true), MaterialClass::ggx25,
                                   ViewSet::one_arc, 64)
                              .worst95();
  const double ridge = measured(iwls_method(Construction::quadtree, false), MaterialClass::ggx25,
                                ViewSet::one_arc, 64)
                           .worst95();
  EXPECT_LT(ridge, 0.7 * faithful);
}

TEST(Stability, QuickSuiteIsFiniteForEveryMethod) {
  const StabilityOptions options = stability_options(1, true);
  const std::vector<StabilityRow> rows = run_stability(options, ignore);
  std::size_t expected = 0;
  for (const StabilitySetting& setting : options.settings) {
    expected += setting.sample_counts.size() * options.methods.size();
  }
  ASSERT_EQ(rows.size(), expected);
  for (const StabilityRow& row : rows) {
    EXPECT_TRUE(std::isfinite(row.rms) && row.rms > 0 && row.rms < 1)
        << row.method << ", " << row.setting << ": " << row.rms;
    EXPECT_TRUE(std::isfinite(row.worst95) && row.worst95 > 0) << row.method;
    EXPECT_GE(row.numbers, 3.0) << row.method;
  }
}

// .10 -> .05 -> .06: the increase is counted from the best so far, 20 %.
TEST(Stability, IncreaseIsCountedFromTheBestSoFar) {
  std::vector<StabilityRow> rows;
  for (const auto& [samples, rms] :
       {std::pair{4u, 0.10}, std::pair{8u, 0.05}, std::pair{16u, 0.06}}) {
    rows.push_back({ViewSet::uni, "base", samples, "m", rms, rms, 0, 1, 3});
  }
  const Table table = monotonicity_of(rows, "m");
  ASSERT_EQ(table.rows.size(), 1u);
  EXPECT_EQ(table.rows[0].back(), "+20.0 % @16");
}

TEST(SceneStudy, QuickSceneIsFinite) {
  SceneStudyOptions options;
  options.methods = all_methods();
  options.sample_counts = {24};
  options.points = 20;
  options.points_per_material = 1;
  for (const SceneRow& row : run_scene_study(options, ignore)) {
    EXPECT_TRUE(std::isfinite(row.psnr_path_db) && row.psnr_path_db > 5) << row.method;
    EXPECT_TRUE(std::isfinite(row.psnr_scattered_db) && row.psnr_scattered_db > 5) << row.method;
  }
}

// With at most `limit` samples nothing is split: one fit per sample. The next one splits the root:
// four fits more.
TEST(Paper, OneLeafCountOfFits) {
  StudyPoint point{MaterialClass::lambert, {}, {}};
  for (std::uint32_t i = 0; i < 13; ++i) {
    const float angle = static_cast<float>(i);
    point.training.push_back({i, {0.5f * std::cos(angle), 0.5f * std::sin(angle)}, {0, 0, 0}});
  }
  EXPECT_EQ(one_leaf_fits(point, 12, 12, 2), 12u);
  EXPECT_EQ(one_leaf_fits(point, 13, 12, 2), 13u + 4u);
}

// The batch construction fits every centre from all samples; once every node of the quadtree that
// holds samples is split, both solve the same systems. With 256 scattered views that is so for
// nearly all nodes: their errors differ by less than 2 %.
TEST(Paper, FaithfulQuadtreeEndsAsBatch) {
  const double quadtree =
      measured(iwls_method(Construction::quadtree, true), MaterialClass::ggx40, ViewSet::uni, 256)
          .mean_rms();
  const double batch =
      measured(iwls_method(Construction::batch, true), MaterialClass::ggx40, ViewSet::uni, 256)
          .mean_rms();
  EXPECT_NEAR(quadtree / batch, 1.0, 0.02);
}

TEST(Paper, TablesHaveTheirRows) {
  const PaperTables tables = run_paper_experiments({.seeds = 1, .points_per_material = 1}, ignore);
  EXPECT_EQ(tables.layouts.rows.size(), 2u * 4u * 4u);
  EXPECT_EQ(tables.incremental.rows.front().size(), tables.incremental.columns.size());
  EXPECT_EQ(tables.fits.rows.size(), 5u);
  EXPECT_EQ(tables.centers.rows.size(), 2u);
}

}  // namespace
}  // namespace sheen::evaluation
