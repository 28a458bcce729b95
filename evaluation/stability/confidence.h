// SPDX-License-Identifier: MIT
#pragma once

#include "evaluation/report/table.h"
#include "evaluation/stability/stability_suite.h"

namespace sheen::evaluation {

/// How well `Fitter::predicted_error` ranks the true error: Spearman's correlation and the
/// probability that an error above .1 is ranked above one below, pooled over all points and
/// held-out directions, 64 samples, for every method that predicts.
Table confidence_study(const StabilityOptions& options, const Progress& progress);

}  // namespace sheen::evaluation
