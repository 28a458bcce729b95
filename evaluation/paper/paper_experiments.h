// SPDX-License-Identifier: MIT
#pragma once

#include "evaluation/report/progress.h"
#include "evaluation/report/table.h"

#include <cstddef>
#include <cstdint>

namespace sheen::evaluation {

/// Size of the paper's experiments on synthetic patches (GGX .25, GGX .40, mix; scattered views).
struct PaperOptions {
  std::size_t seeds = 5;                 ///< repetitions with other points, views and noise
  std::size_t points_per_material = 20;  ///< times three materials
  std::uint64_t seed = 1;                ///< the first one
};

/// The paper's experiments (Coombe and Lastra 2006, section 4), its own figures beside ours.
struct PaperTables {
  Table layouts;      ///< Table 2: four layouts, 64 training and 74 evaluation directions
  Table incremental;  ///< Figure 6: error while images arrive, constructions against batch
  Table fits;         ///< least-squares fits per patch and view
  Table centers;      ///< 64 centres against 16: time and bytes
};

PaperTables run_paper_experiments(const PaperOptions& options, const Progress& progress);

}  // namespace sheen::evaluation
