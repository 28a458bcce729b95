// SPDX-License-Identifier: MIT
#pragma once

#include "core/image/metrics.h"
#include "evaluation/comparison/candidates.h"
#include "evaluation/comparison/observations.h"
#include "evaluation/comparison/outline_error.h"
#include "render/context/context.h"

#include <filesystem>

namespace sheen::evaluation {

/// Everything measured of one candidate on one recording.
struct CandidateMeasurement {
  core::ImageError error;    ///< means over the held-out views
  double live_psnr_db = 0;   ///< the same, with the model as it was after the last frame
  double worst_psnr_db = 0;  ///< of the worst view
  OutlineError outline;      ///< means over the held-out views
  double pop_ratio = 0;      ///< of a model that was read from its file, along a smooth path
  std::size_t views = 0;     ///< held-out views that show the object
  std::size_t samples = 0;
  std::size_t patches = 0;
  std::size_t coefficients = 0;
  std::uintmax_t model_bytes = 0;
  std::uintmax_t light_field_bytes = 0;  ///< of them, without the mesh
  /// Memory that a model which was read and drawn holds: mesh, model, textures, caches. 0
  /// where the C library does not tell.
  std::size_t drawing_bytes = 0;
  double fit_ms = 0;          ///< CPU, all frames and `finish`
  double finish_ms = 0;       ///< `finish` alone
  double fit_frame_ms = 0;    ///< fit_ms over the fitted frames
  double render_view_ms = 0;  ///< CPU per view, median: the first draws compile shaders
};

/// Fits, saves to `scratch` (removed again), draws the held-out views and compares. Throws
/// core::Error (run_failed) for models the driver cannot draw.
CandidateMeasurement measure_candidate(const Candidate& candidate, const Observations& observations,
                                       render::Context& gl, const std::filesystem::path& scratch,
                                       int threads, pipeline::ProgressSink& sink);

}  // namespace sheen::evaluation
