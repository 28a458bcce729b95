// SPDX-License-Identifier: MIT
#include "evaluation/stability/stability_suite.h"

#include "evaluation/study/measure.h"

#include <fmt/core.h>

namespace sheen::evaluation {
namespace {

struct NamedCorruption {
  const char* name;
  Corruption corruption;
};

std::vector<NamedCorruption> corruptions() {
  return {{"noise 0", {.noise = 0.0f}},          {"noise .02", {.noise = 0.02f}},
          {"noise .05", {.noise = 0.05f}},       {"pose 0", {.pose_error = 0.0f}},
          {"pose 1.5", {.pose_error = 1.5f}},    {"pose 3", {.pose_error = 3.0f}},
          {"outliers 2 %", {.outliers = 0.02f}}, {"outliers 10 %", {.outliers = 0.1f}},
          {"no clamp", {.clamp = false}},        {"exposure x2", {.exposure = 2.0f}}};
}

double mean_rms_glossy(const Measurement& measured, const StudySet& set) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < set.points.size(); ++i) {
    if (set.points[i].material == MaterialClass::lambert) continue;
    sum += measured.points[i].rms;
    ++count;
  }
  return count == 0 ? 0.0 : sum / static_cast<double>(count);
}

}  // namespace

StabilityOptions stability_options(std::uint64_t seed, bool is_quick) {
  StabilityOptions options;
  options.seed = seed;
  options.methods = all_methods();
  options.points_per_material = is_quick ? 1 : 20;
  const std::vector<std::size_t> all{4, 8, 16, 32, 64, 128, 256};
  const std::vector<std::size_t> few{16, 64, 256};
  const std::vector<std::size_t> quick{4, 16};
  for (const ViewSet views : kViewSets) {
    options.settings.push_back({views, "base", {}, is_quick ? quick : all});
  }
  for (const ViewSet views : {ViewSet::uni, ViewSet::arc}) {
    for (const NamedCorruption& changed : corruptions()) {
      options.settings.push_back({views, changed.name, changed.corruption, is_quick ? quick : few});
    }
  }
  return options;
}

std::vector<StabilityRow> run_stability(const StabilityOptions& options, const Progress& progress) {
  const Environment environment = studio_environment();
  std::vector<StabilityRow> rows;
  for (const StabilitySetting& setting : options.settings) {
    progress(fmt::format("stability: {}, {}", name_of(setting.views), setting.name));
    for (const std::size_t samples : setting.sample_counts) {
      TestBedOptions bed;
      bed.points_per_material = options.points_per_material;
      bed.views = setting.views;
      bed.training_views = samples;
      bed.corruption = setting.corruption;
      bed.seed = options.seed;
      const StudySet set = make_test_bed(bed, environment);
      for (const Method& method : options.methods) {
        const Measurement measured = measure(method, set);
        rows.push_back({setting.views, setting.name, samples, method.name, measured.mean_rms(),
                        mean_rms_glossy(measured, set), measured.mean_rms_in_gap(),
                        measured.worst95(), measured.coefficients_per_point});
      }
    }
  }
  return rows;
}

}  // namespace sheen::evaluation
