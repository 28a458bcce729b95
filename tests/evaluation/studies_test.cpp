// SPDX-License-Identifier: MIT
#include "evaluation/paper/incremental.h"
#include "evaluation/paper/layouts.h"
#include "evaluation/scene/scene_study.h"
#include "evaluation/stability/stability_suite.h"
#include "evaluation/stability/stability_tables.h"
#include "evaluation/study/measure.h"
#include "fitting/descriptor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

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

/// Numbers that a method stores per patch when every patch has so many samples: three for each
/// term, five for each sample that is kept. Nothing where the fit decides.
std::optional<double> numbers_of(const Method& method, std::size_t samples) {
  if (method.representation == "mean") return 3;
  if (method.representation == "nearest-views") return 5.0 * static_cast<double>(samples);
  const auto options =
      fitting::options_from(fitting::representation_named(method.representation), method.options);
  const auto value_of = [&](const std::string& name) -> double {
    for (const fitting::FitOption& option : options->table()) {
      if (option.name == name) return std::stod(option.get());
    }
    ADD_FAILURE() << method.name << " has no " << name;
    return 0;
  };
  if (method.representation == "sh") return 3 * std::pow(value_of("degree") + 1, 2);
  if (method.representation == "iwls") return 3 * value_of("centers") * value_of("terms");
  return std::nullopt;
}

/// The quick suite, run once; rows by view set, setting, samples and method.
class Stability : public testing::Test {
 protected:
  using Key = std::tuple<ViewSet, std::string, std::size_t, std::string>;

  static void SetUpTestSuite() {
    options_ = stability_options(1, true);
    for (const StabilityRow& row : run_stability(options_, ignore)) {
      rows_.insert({{row.views, row.setting, row.samples, row.method}, row});
    }
  }
  static const StabilityRow& row(ViewSet views, const char* setting, std::size_t samples,
                                 const std::string& method) {
    return rows_.at({views, setting, samples, method});
  }
  static double rms(ViewSet views, const char* setting, std::size_t samples,
                    const std::string& method) {
    return row(views, setting, samples, method).rms;
  }

  static inline StabilityOptions options_;
  static inline std::map<Key, StabilityRow> rows_;
};

TEST_F(Stability, SuiteMeasuresEverythingThatItNames) {
  std::size_t expected = 0;
  for (const StabilitySetting& setting : options_.settings) {
    expected += setting.sample_counts.size() * options_.methods.size();
  }
  EXPECT_EQ(rows_.size(), expected);
  for (const auto& [key, row] : rows_) {
    // The mean over points of a root mean square is no more than their worst.
    EXPECT_TRUE(row.rms > 0 && row.rms <= row.worst95 && std::isfinite(row.worst95))
        << row.method << ", " << row.setting << ": " << row.rms << ", " << row.worst95;
    EXPECT_LT(row.rms, 1) << row.method;
  }
  for (const Method& method : options_.methods) {
    for (const std::size_t samples : {4u, 16u}) {
      const double numbers = row(ViewSet::uni, "base", samples, method.name).numbers;
      EXPECT_EQ(numbers, numbers_of(method, samples).value_or(numbers)) << method.name;
      EXPECT_GE(numbers, 3) << method.name;
    }
  }
}

// More views from all sides tell more, noise and false samples tell less: nine points of nine
// materials, and no method is an exception. (Along arcs more views may fool a fit that nothing
// holds back; that is what the suite is for.)
TEST_F(Stability, ErrorsFallWithViewsAndRiseWithNoise) {
  for (const Method& method : options_.methods) {
    SCOPED_TRACE(method.name);
    EXPECT_LT(rms(ViewSet::uni, "base", 16, method.name),
              rms(ViewSet::uni, "base", 4, method.name));
    for (const std::size_t samples : {4u, 16u}) {
      for (const ViewSet views : {ViewSet::uni, ViewSet::arc}) {
        EXPECT_LT(rms(views, "noise 0", samples, method.name),
                  rms(views, "noise .05", samples, method.name));
      }
      EXPECT_LT(rms(ViewSet::uni, "base", samples, method.name),
                rms(ViewSet::uni, "outliers 10 %", samples, method.name));
    }
  }
}

// One colour does not ask for the direction, so a wrong one does no harm.
TEST_F(Stability, MeanDoesNotMindPoseErrors) {
  for (const ViewSet views : {ViewSet::uni, ViewSet::arc}) {
    for (const std::size_t samples : {4u, 16u}) {
      EXPECT_EQ(rms(views, "pose 0", samples, "mean"), rms(views, "pose 3", samples, "mean"));
    }
  }
}

// What is held back loses to one colour nowhere among 16 scattered views: .104 to .116 against .141
// were measured.
TEST_F(Stability, WhatIsHeldBackBeatsTheMean) {
  for (const Method& method : options_.methods) {
    if (method.name == "mean" || method.name.ends_with("faithful") ||
        method.name == free_harmonics_method().name) {
      continue;
    }
    EXPECT_LT(rms(ViewSet::uni, "base", 16, method.name),
              0.9 * rms(ViewSet::uni, "base", 16, "mean"))
        << method.name;
  }
}

// .10 -> .05 -> .06: the increase is counted from the best so far, 20 %.
TEST(StabilityTables, IncreaseIsCountedFromTheBestSoFar) {
  std::vector<StabilityRow> rows;
  for (const auto& [samples, rms] :
       {std::pair{4u, 0.10}, std::pair{8u, 0.05}, std::pair{16u, 0.06}}) {
    rows.push_back({ViewSet::uni, "base", samples, "m", rms, rms, 0, 1, 3});
  }
  const Table table = monotonicity_of(rows, "m");
  ASSERT_EQ(table.rows.size(), 1u);
  EXPECT_EQ(table.rows[0].back(), "+20.0 % @16");
}

// 24 samples of noise .01, rounded to 1/255: on matt points one colour is the whole truth, and
// nobody is nearer to it than its mean, off by sqrt((.01^2 + (1/255)^2 / 12) / 24) = .0021 on
// average. On the whole object, three tenths of it glossy, every method that something holds back
// is better by 4.2 to 10.7 dB on the walk and 2.1 to 4.8 dB from scattered cameras; less than half
// of that would be another result.
TEST(SceneStudy, MeanIsBestOnMattPointsAndWorstOnTheObject) {
  SceneStudyOptions options;
  options.methods = all_methods();
  options.sample_counts = {24};
  options.points = 20;
  options.points_per_material = 1;
  const std::vector<SceneRow> rows = run_scene_study(options, ignore);
  ASSERT_EQ(rows.size(), 2 * options.methods.size());  // under two environments
  for (const SceneRow& row : rows) {
    SCOPED_TRACE(row.method + ", " + row.environment);
    const SceneRow& mean = *std::find_if(rows.begin(), rows.end(), [&](const SceneRow& other) {
      return other.method == "mean" && other.environment == row.environment;
    });
    const bool is_mean = row.method == "mean";
    if (is_mean) {
      EXPECT_NEAR(row.lambert_rms, 0.0021, 0.5 * 0.0021);
    } else {
      EXPECT_GT(row.lambert_rms, mean.lambert_rms);
    }
    if (is_mean || row.method.ends_with("faithful") || row.method == free_harmonics_method().name) {
      continue;
    }
    EXPECT_GT(row.psnr_path_db, mean.psnr_path_db + 2.1);
    EXPECT_GT(row.psnr_scattered_db, mean.psnr_scattered_db + 1.0);
    EXPECT_GT(row.numbers, mean.numbers);
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

/// A cell by the texts in the first columns of its row and the name of its column, as a number.
double cell(const Table& table, const std::vector<std::string>& row, const std::string& column) {
  const auto found = std::find(table.columns.begin(), table.columns.end(), column);
  for (const auto& cells : table.rows) {
    if (cells.size() == table.columns.size() && found != table.columns.end() &&
        std::equal(row.begin(), row.end(), cells.begin())) {
      return std::stod(cells[static_cast<std::size_t>(found - table.columns.begin())]);
    }
  }
  ADD_FAILURE() << table.title << " has no " << row.front() << ", " << column;
  return std::nan("");
}

// All tables look at the same patches, so that the same fit gives the same figure wherever it
// stands: the quadtree of 16 centres after all 64 views.
TEST(Paper, TablesAgreeWithEachOther) {
  const PaperTables tables = run_paper_experiments({.seeds = 1, .points_per_material = 1}, ignore);
  const std::string faithful = "quadtree 16x3 faithful";
  const std::string ridge = "quadtree 16x3 ridge";
  const double quadtree = cell(tables.layouts, {faithful, "uni", "grid"}, "mean");
  EXPECT_EQ(cell(tables.incremental, {"64"}, faithful), quadtree);
  EXPECT_EQ(cell(tables.centers, {"faithful"}, "RMS 16"), quadtree);
  EXPECT_EQ(cell(tables.layouts, {ridge, "uni", "grid"}, "mean"),
            cell(tables.incremental, {"64"}, ridge));
  EXPECT_EQ(cell(tables.centers, {"ridge"}, "RMS 16"), cell(tables.incremental, {"64"}, ridge));

  // Layouts: two view sets, four constructions, four layouts; one seed has no spread, a patch is at
  // worst no better than all.
  EXPECT_EQ(tables.layouts.rows.size(), 2u * 4u * 4u);
  for (const auto& row : tables.layouts.rows) {
    const std::vector<std::string> key(row.begin(), row.begin() + 3);
    EXPECT_EQ(cell(tables.layouts, key, "spread over seeds"), 0);
    EXPECT_GE(cell(tables.layouts, key, "worst patch"), cell(tables.layouts, key, "mean"));
  }

  // While images arrive the error falls, and it is smaller at the samples than between them.
  EXPECT_EQ(tables.incremental.rows.size(), 14u);
  for (std::size_t i = 1; i < tables.incremental.columns.size(); i += 2) {
    const std::string& method = tables.incremental.columns[i];
    SCOPED_TRACE(method);
    EXPECT_LT(cell(tables.incremental, {"64"}, method), cell(tables.incremental, {"24"}, method));
    EXPECT_LT(cell(tables.incremental, {"24"}, method), cell(tables.incremental, {"4"}, method));
    EXPECT_LT(cell(tables.incremental, {"64"}, method + " (all samples)"),
              cell(tables.incremental, {"64"}, method));
  }

  // A view is fitted at least once, in every leaf that covers it no less often than in one.
  EXPECT_EQ(tables.fits.rows.size(), 5u);
  for (const char* views : {"16", "32", "64", "128", "256"}) {
    const double one_leaf = cell(tables.fits, {views}, "quadtree, one leaf + 4 per split");
    EXPECT_GE(one_leaf, 1);
    EXPECT_GE(cell(tables.fits, {views}, "quadtree, every covering leaf"), one_leaf);
  }

  // 16 or 64 centres of three terms, three channels, two bytes.
  EXPECT_EQ(tables.centers.rows.size(), 2u);
  for (const char* rules : {"faithful", "ridge"}) {
    EXPECT_EQ(cell(tables.centers, {rules}, "bytes per patch, 16"), 16 * 3 * 3 * 2);
    EXPECT_EQ(cell(tables.centers, {rules}, "bytes per patch, 64"), 64 * 3 * 3 * 2);
    EXPECT_LT(cell(tables.centers, {rules}, "RMS 64"), cell(tables.centers, {rules}, "RMS 16"));
  }
}

}  // namespace
}  // namespace sheen::evaluation
