// SPDX-License-Identifier: MIT
#pragma once

#include "evaluation/billboards/billboard_errors.h"
#include "evaluation/report/table.h"

#include <string>
#include <vector>

namespace sheen::evaluation {

/// The paper's tables as this program makes them.
struct BillboardStudy {
  std::vector<BillboardErrors> hard;         ///< all views and bakes, outlines as in the paper
  std::vector<BillboardErrors> antialiased;  ///< the same with 4 x 4 points a pixel
  std::vector<BillboardErrors> hard_twice;   ///< orthographic, frames and images twice as large
  int side_px = 0;
};

BillboardStudy run_billboard_study(const core::Mesh& mesh, int side_px, int threads,
                                   const Progress& progress);

/// One for each field of view of the viewer: averages, hard and antialiased, beside the paper's.
std::vector<Table> average_tables(const BillboardStudy& study);
/// Everything, one line for each size, view, bake, kind of outline and distance.
Table all_figures(const BillboardStudy& study);
/// The law's terms for orthographic frames, hard outlines, and where it is least.
Table law_table(const BillboardStudy& study);
/// What a correct implementation shows, and whether this run does.
Table rule_table(const BillboardStudy& study);

}  // namespace sheen::evaluation
