// SPDX-License-Identifier: MIT
#pragma once

#include "evaluation/study/corruption.h"
#include "evaluation/study/environment.h"
#include "evaluation/study/study_set.h"
#include "evaluation/study/view_sets.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sheen::evaluation {

/// Independent points, each with views of its own.
struct TestBedOptions {
  std::vector<MaterialClass> materials{kMaterialClasses.begin(), kMaterialClasses.end()};
  std::size_t points_per_material = 20;
  ViewSet views = ViewSet::uni;
  std::size_t training_views = 64;  ///< of every point
  std::size_t test_views = 74;      ///< scattered, without noise
  Corruption corruption;
  std::uint64_t seed = 1;
};

/// The points and their truth depend on the seed only; views on seed and view set; noise on seed
/// and view. So the samples for N views are among those for 2 N, and two settings differ in nothing
/// but what was set. Frame k holds view k of every point.
StudySet make_test_bed(const TestBedOptions& options, const Environment& environment);

/// Part of all training samples with a channel at or above 1 before noise and clamp, [0, 1].
double clamped_fraction(const TestBedOptions& options, const Environment& environment);

}  // namespace sheen::evaluation
