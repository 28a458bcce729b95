// SPDX-License-Identifier: MIT
#pragma once

#include "bench/paper/paper_experiments.h"
#include "bench/study/test_bed.h"

namespace sheen::bench {

/// Points of the paper's experiments: materials between matte and mirror, 64 training views.
TestBedOptions paper_test_bed(const PaperOptions& options, std::size_t repetition);

/// Table 2.
Table layout_experiment(const PaperOptions& options, const Progress& progress);

}  // namespace sheen::bench
