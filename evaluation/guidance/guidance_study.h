// SPDX-License-Identifier: MIT
#pragma once

#include "evaluation/report/progress.h"
#include "evaluation/report/table.h"

#include <cstdint>

namespace sheen::evaluation {

struct GuidanceStudyOptions {
  int scenes = 4;          ///< seeds the figures are means over
  int frames = 600;        ///< of a walk, 1.5 degrees each
  std::uint64_t seed = 1;  ///< of the first scene
};

/// Rank correlation of every score with the true error of patches, and of patches and directions,
/// after a sweep that leaves a gap.
Table ranking_table(const GuidanceStudyOptions& options, const Progress& progress);

/// Frames until the error on views from everywhere is below some goals, for the first
/// `options.frames` of a plain sweep and for somebody who follows the hint as long.
Table walk_table(const GuidanceStudyOptions& options, const Progress& progress);

}  // namespace sheen::evaluation
