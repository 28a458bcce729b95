// SPDX-License-Identifier: MIT
#pragma once

#include "evaluation/report/progress.h"
#include "evaluation/study/material.h"
#include "evaluation/study/methods.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace sheen::evaluation {

/// Materials of the scene, matte ones first.
inline constexpr std::array kSceneMaterials{MaterialClass::lambert, MaterialClass::ggx60,
                                            MaterialClass::ggx25, MaterialClass::mix,
                                            MaterialClass::ggx15};

/// Size of the study of a whole object.
struct SceneStudyOptions {
  std::vector<Method> methods;
  std::vector<std::size_t> sample_counts{24, 48, 96, 192};  ///< per point, on average
  std::size_t points = 400;
  std::size_t points_per_material = 20;  ///< of the nine materials under the busy environment
  std::uint64_t seed = 1;
};

/// What a method makes of the scene.
struct SceneRow {
  std::string environment;  ///< "studio" or "busy"
  std::string setting;      ///< "base" or "outliers 2 %"
  std::size_t samples;
  std::string method;
  double psnr_path_db;       ///< held-out handheld walk, pooled over points and views
  double psnr_scattered_db;  ///< scattered cameras
  double numbers;            ///< coefficients per patch
  std::array<double, kSceneMaterials.size()> numbers_by_material;
  double lambert_rms;  ///< mean over the Lambert points, walk
  double fit_us;       ///< CPU time per sample, microseconds
};

/// 70 % matt, 30 % glossy, under both environments and with outliers.
std::vector<SceneRow> run_scene_study(const SceneStudyOptions& options, const Progress& progress);

/// Error under the busy environment, nine materials.
struct BusyRow {
  std::string views;
  std::size_t samples;
  std::string method;
  double rms;
  double worst95;
  double numbers;
};
std::vector<BusyRow> run_busy_study(const SceneStudyOptions& options, const Progress& progress);

}  // namespace sheen::evaluation
