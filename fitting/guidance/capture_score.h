// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/guidance/frame_gate.h"
#include "fitting/guidance/quality_curve.h"
#include "fitting/guidance/view_utility.h"

namespace sheen::fitting::guidance {

/// What is kept while views arrive: where they are missing, whether they fit, how good it gets.
struct CaptureScore {
  ViewUtility utility;
  FrameGate gate;
  QualityCurve curve;

  explicit CaptureScore(std::size_t patch_count) : utility(patch_count) {}

  /// Judges a view before it is integrated.
  FrameVerdict judge(const core::SampleBatch& batch, const PatchLightField& model) {
    score_ = utility.score(batch, model);
    return gate.judge(score_);
  }

  /// The view judged last is about to be integrated; `coverage` as known, [0, 1].
  void note(const core::SampleBatch& batch, double coverage) {
    utility.note(batch);
    curve.add(score_, coverage);
  }

 private:
  FrameScore score_;
};

}  // namespace sheen::fitting::guidance
