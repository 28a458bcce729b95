// SPDX-License-Identifier: MIT
#pragma once

#include "evaluation/paper/paper_experiments.h"
#include "evaluation/study/test_bed.h"

namespace sheen::evaluation {

/// Points of the paper's experiments: materials between matte and mirror, 64 training views.
TestBedOptions paper_test_bed(const PaperOptions& options, std::size_t repetition);

/// Table 2.
Table layout_experiment(const PaperOptions& options, const Progress& progress);

}  // namespace sheen::evaluation
