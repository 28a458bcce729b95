// SPDX-License-Identifier: MIT
#pragma once

#include "evaluation/report/progress.h"
#include "evaluation/report/table.h"
#include "evaluation/study/methods.h"
#include "evaluation/study/test_bed.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace sheen::evaluation {

/// One way in which samples may be bad.
struct StabilitySetting {
  ViewSet views = ViewSet::uni;
  std::string name;  ///< what was changed, e.g. "noise .05"; "base" for nothing
  Corruption corruption;
  std::vector<std::size_t> sample_counts;  ///< rising
};

/// Size of the suite.
struct StabilityOptions {
  std::vector<StabilitySetting> settings;
  std::vector<Method> methods;
  std::size_t points_per_material = 20;  ///< times nine materials
  std::uint64_t seed = 1;
};

/// Error of one method in one setting.
struct StabilityRow {
  ViewSet views;
  std::string setting;
  std::size_t samples;
  std::string method;
  double rms;         ///< mean over points, held-out directions, clamped to [0, 1]
  double rms_glossy;  ///< the same without Lambert
  double rms_in_gap;  ///< only directions of the sector that ViewSet::gap leaves out
  double worst95;     ///< 95th percentile over points of the worst error before clamping
  double numbers;     ///< coefficients per patch
};

/// All view sets with 4 to 256 samples; on scattered views and arcs noise 0 to .05, pose error 0 to
/// 3 degrees, outliers 2 and 10 %, no clamp and doubled exposure with 16, 64 and 256.
StabilityOptions stability_options(std::uint64_t seed, bool quick);

std::vector<StabilityRow> run_stability(const StabilityOptions& options, const Progress& progress);

}  // namespace sheen::evaluation
