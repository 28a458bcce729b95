// SPDX-License-Identifier: MIT
#pragma once

#include "evaluation/paper/paper_experiments.h"
#include "evaluation/study/study_set.h"

#include <cstddef>

namespace sheen::evaluation {

/// Figure 6: error while images arrive.
Table incremental_experiment(const PaperOptions& options, const Progress& progress);

/// Least-squares fits per patch and view.
Table fit_count_experiment(const PaperOptions& options, const Progress& progress);

/// 64 centres against 16.
Table center_experiment(const PaperOptions& options, const Progress& progress);

/// Fits of a quadtree in which a sample enters only the leaf that contains it: one per sample, four
/// per split; leaves split above `limit` samples, down to `depth` levels. The paper's count of 1.7.
std::size_t one_leaf_fits(const StudyPoint& point, std::size_t samples, std::size_t limit,
                          int depth);

}  // namespace sheen::evaluation
