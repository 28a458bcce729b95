// SPDX-License-Identifier: MIT
#pragma once

#include "evaluation/study/corruption.h"
#include "evaluation/study/environment.h"
#include "evaluation/study/study_set.h"

#include <cstddef>
#include <cstdint>

namespace sheen::evaluation {

/// An object of many points seen by one camera: 40 % Lambert, 30 % GGX .60, 10 % each of GGX .25,
/// mix and GGX .15.
struct SceneOptions {
  std::size_t points = 400;
  std::size_t samples_per_point = 96;  ///< on average; the walk is as long as that takes
  /// The pose error is one per frame, as a tracker's is. Exposed so that the mean colour alone
  /// gives about 28 dB.
  Corruption corruption{.exposure = 0.5f};
  std::uint64_t seed = 1;
};

/// The scene with two sets of test views.
struct Scene {
  StudySet path;       ///< tests along another handheld walk
  StudySet scattered;  ///< the same training, tests from cameras scattered over the same heights
};

/// Normals over the sphere down to 12 degrees below the horizon, far camera on a handheld walk of
/// three rounds; a point sees a frame when n . v > kMinCosine.
Scene make_scene(const SceneOptions& options, const Environment& environment);

}  // namespace sheen::evaluation
