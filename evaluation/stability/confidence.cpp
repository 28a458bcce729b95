// SPDX-License-Identifier: MIT
#include "evaluation/stability/confidence.h"

#include "evaluation/study/measure.h"
#include "evaluation/study/rank_correlation.h"

#include <fmt/core.h>

#include <array>
#include <memory>
#include <utility>

namespace sheen::evaluation {
namespace {

// Error above which a viewer would like another view.
constexpr double kLargeError = 0.1;

struct Predictions {
  std::vector<double> predicted;
  std::vector<double> actual;
};

Predictions predictions(const fitting::PatchFitter& fitter, const StudySet& set) {
  Predictions result;
  for (std::size_t patch = 0; patch < set.points.size(); ++patch) {
    for (const TestSample& test : set.points[patch].test) {
      const auto predicted = fitter.predicted_error(patch, test.uv);
      if (!predicted) continue;
      result.predicted.push_back(static_cast<double>(*predicted));
      result.actual.push_back(point_error(fitter.light_field(), patch, {&test, 1}).rms);
    }
  }
  return result;
}

std::string quality_cell(const Predictions& predictions) {
  const std::size_t count = predictions.actual.size();
  const auto large = std::make_unique<bool[]>(count);
  for (std::size_t i = 0; i < count; ++i) large[i] = predictions.actual[i] > kLargeError;
  return fmt::format("{:.2f} / {:.2f}", spearman(predictions.predicted, predictions.actual),
                     ranking_quality(predictions.predicted, {large.get(), count}));
}

}  // namespace

Table confidence_study(const StabilityOptions& options, const Progress& progress) {
  constexpr std::array view_sets{ViewSet::uni, ViewSet::arc, ViewSet::gap};
  Table table{
      "Predicted against true error, 64 samples: Spearman / area under curve for error > .1",
      {"method"},
      {}};
  std::vector<StudySet> sets;
  for (const ViewSet views : view_sets) {
    progress(fmt::format("confidence: {}", name_of(views)));
    table.columns.emplace_back(name_of(views));
    TestBedOptions bed;
    bed.points_per_material = options.points_per_material;
    bed.views = views;
    bed.seed = options.seed;
    sets.push_back(make_test_bed(bed, studio_environment()));
  }
  for (const Method& method : options.methods) {
    std::vector<std::string> line{method.name};
    for (const StudySet& set : sets) {
      const auto fitter = method.make(set.points.size());
      for (const core::SampleBatch& batch : set.batches()) fitter->integrate(batch);
      fitter->finish();
      const Predictions pairs = predictions(*fitter, set);
      if (pairs.predicted.empty()) break;
      line.push_back(quality_cell(pairs));
    }
    if (line.size() == table.columns.size()) table.rows.push_back(std::move(line));
  }
  return table;
}

}  // namespace sheen::evaluation
