// SPDX-License-Identifier: MIT
#include "evaluation/scene/scene_study.h"

#include "evaluation/study/measure.h"
#include "evaluation/study/scene.h"
#include "evaluation/study/test_bed.h"

#include <fmt/core.h>

#include <array>
#include <utility>

namespace sheen::evaluation {
namespace {

SceneRow measure_scene(const Method& method, const Scene& scene) {
  SceneRow row{};
  row.method = method.name;
  // Fit the whole object.
  const Measurement on_path = measure(method, scene.path);
  row.psnr_path_db = on_path.pooled_psnr_db(scene.path);
  row.psnr_scattered_db = measure(method, scene.scattered).pooled_psnr_db(scene.scattered);
  row.numbers = on_path.coefficients_per_point;
  row.fit_us = on_path.fit_us;
  // Patches do not know each other: each material fitted alone shows where the numbers are.
  for (std::size_t i = 0; i < kSceneMaterials.size(); ++i) {
    const Measurement part = measure(method, only(scene.path, kSceneMaterials[i]));
    row.numbers_by_material[i] = part.coefficients_per_point;
    if (kSceneMaterials[i] == MaterialClass::lambert) row.lambert_rms = part.mean_rms();
  }
  return row;
}

void add_rows(const SceneStudyOptions& options, const Environment& environment,
              const SceneOptions& scene_options, const SceneRow& labels,
              std::vector<SceneRow>& rows) {
  const Scene scene = make_scene(scene_options, environment);
  for (const Method& method : options.methods) {
    SceneRow row = measure_scene(method, scene);
    row.environment = labels.environment;
    row.setting = labels.setting;
    row.samples = scene_options.samples_per_point;
    rows.push_back(std::move(row));
  }
}

}  // namespace

std::vector<SceneRow> run_scene_study(const SceneStudyOptions& options, const Progress& progress) {
  std::vector<SceneRow> rows;
  const std::array environments{std::pair{"studio", studio_environment()},
                                std::pair{"busy", busy_environment()}};
  for (const auto& [name, environment] : environments) {
    for (const std::size_t samples : options.sample_counts) {
      progress(fmt::format("scene: {}, {} samples per point", name, samples));
      SceneOptions scene;
      scene.points = options.points;
      scene.samples_per_point = samples;
      scene.seed = options.seed;
      SceneRow labels{};
      labels.environment = name;
      labels.setting = "base";
      add_rows(options, environment, scene, labels, rows);
      if (samples != 96) continue;
      scene.corruption.outliers = 0.02f;
      labels.setting = "outliers 2 %";
      add_rows(options, environment, scene, labels, rows);
    }
  }
  return rows;
}

std::vector<BusyRow> run_busy_study(const SceneStudyOptions& options, const Progress& progress) {
  std::vector<BusyRow> rows;
  const Environment environment = busy_environment();
  for (const auto& [views, samples] : {std::pair{ViewSet::uni, 64u}, std::pair{ViewSet::uni, 256u},
                                       std::pair{ViewSet::arc, 64u}}) {
    progress(fmt::format("busy environment: {}, {} samples", name_of(views), samples));
    TestBedOptions bed;
    bed.points_per_material = options.points_per_material;
    bed.views = views;
    bed.training_views = samples;
    bed.seed = options.seed;
    const StudySet set = make_test_bed(bed, environment);
    for (const Method& method : options.methods) {
      const Measurement measured = measure(method, set);
      rows.push_back({std::string(name_of(views)), samples, method.name, measured.mean_rms(),
                      measured.worst95(), measured.coefficients_per_point});
    }
  }
  return rows;
}

}  // namespace sheen::evaluation
