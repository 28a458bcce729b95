// SPDX-License-Identifier: MIT
#pragma once

#include "evaluation/study/methods.h"
#include "evaluation/study/study_set.h"

#include <cstddef>
#include <span>
#include <vector>

namespace sheen::evaluation {

/// How far a light field is from the truth at one point. Predictions are clamped to [0, 1] for
/// `rms`; `worst` is the largest absolute error of any channel before that clamp.
struct PointError {
  double rms = 0;
  double worst = 0;
  double rms_in_gap = 0;  ///< over test samples of the held-out sector only; 0 without any
};

/// What a method made of a set.
struct Measurement {
  std::vector<PointError> points;
  double coefficients_per_point = 0;
  double fit_us = 0;  ///< CPU time of integrate and finish per sample, microseconds

  [[nodiscard]] double mean_rms() const;    ///< over points
  [[nodiscard]] double rms_spread() const;  ///< standard deviation over points
  [[nodiscard]] double mean_rms_in_gap() const;
  [[nodiscard]] double worst95() const;  ///< 95th percentile over points of `worst`
  [[nodiscard]] double pooled_psnr_db(const StudySet& set) const;  ///< over all test samples
};

PointError point_error(const fitting::PatchLightField& light_field, std::size_t patch_idx,
                       std::span<const TestSample> test);

/// Errors of all points of a set.
std::vector<PointError> point_errors(const fitting::PatchLightField& light_field,
                                     const StudySet& set);

/// Integrates all views, one frame after the other, finishes and compares.
Measurement measure(const Method& method, const StudySet& set);

}  // namespace sheen::evaluation
