// SPDX-License-Identifier: MIT
#include "evaluation/paper/layouts.h"

#include "evaluation/study/measure.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace sheen::evaluation {
namespace {

using fitting::iwls::Construction;
using fitting::iwls::Layout;

// The paper's Table 2.
struct PaperRow {
  Layout layout;
  const char* mean;
  const char* spread;
};
constexpr std::array kPaperRows{
    PaperRow{Layout::grid, ".0519", ".0086"}, PaperRow{Layout::jittered_grid, ".0608", ".0148"},
    PaperRow{Layout::disk, ".0497", ".0045"}, PaperRow{Layout::jittered_disk, ".0498", ".0036"}};

// Mean over the seeds of the mean over the patches, and both spreads.
struct LayoutError {
  double mean = 0;
  double patch_spread = 0;  // mean over the seeds
  double seed_spread = 0;   // of the mean
  double worst = 0;         // patch, over all seeds
};

LayoutError error_over_seeds(const Method& method, const std::vector<StudySet>& sets) {
  LayoutError error;
  double squares = 0;
  for (const StudySet& set : sets) {
    const Measurement measured = measure(method, set);
    const double mean = measured.mean_rms();
    error.mean += mean;
    squares += mean * mean;
    error.patch_spread += measured.rms_spread();
    for (const PointError& point : measured.points) error.worst = std::max(error.worst, point.rms);
  }
  const auto count = static_cast<double>(sets.size());
  error.mean /= count;
  error.patch_spread /= count;
  error.seed_spread = std::sqrt(std::max(0.0, squares / count - error.mean * error.mean));
  return error;
}

}  // namespace

TestBedOptions paper_test_bed(const PaperOptions& options, std::size_t repetition) {
  TestBedOptions bed;
  bed.materials = {MaterialClass::ggx25, MaterialClass::ggx40, MaterialClass::mix};
  bed.points_per_material = options.points_per_material;
  bed.training_views = 64;
  bed.test_views = 74;
  bed.seed = options.seed + repetition;
  return bed;
}

Table layout_experiment(const PaperOptions& options, const Progress& progress) {
  Table table{"Table 2: layouts, 64 training and 74 evaluation directions, 16 centers, RMS",
              {"construction", "views", "layout", "paper mean", "paper spread", "mean",
               "spread over patches", "spread over seeds", "worst patch"},
              {}};
  const Environment environment = studio_environment();
  constexpr std::array settings{
      std::pair{Construction::quadtree, true}, std::pair{Construction::adaptive, true},
      std::pair{Construction::batch, true}, std::pair{Construction::quadtree, false}};
  for (const ViewSet views : {ViewSet::uni, ViewSet::arc}) {
    progress(fmt::format("layouts: {}", name_of(views)));
    std::vector<StudySet> sets;
    for (std::size_t repetition = 0; repetition < options.seeds; ++repetition) {
      TestBedOptions bed = paper_test_bed(options, repetition);
      bed.views = views;
      sets.push_back(make_test_bed(bed, environment));
    }
    for (const auto& [construction, faithful] : settings) {
      for (const PaperRow& row : kPaperRows) {
        const Method method = iwls_method(construction, faithful, 16, 3, row.layout);
        const LayoutError error = error_over_seeds(method, sets);
        table.rows.push_back({method.name, std::string(name_of(views)),
                              std::string(name_of(row.layout)), row.mean, row.spread,
                              decimals(error.mean, 4), decimals(error.patch_spread, 4),
                              decimals(error.seed_spread, 4), decimals(error.worst, 3)});
      }
    }
  }
  return table;
}

}  // namespace sheen::evaluation
