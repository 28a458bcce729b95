// SPDX-License-Identifier: MIT
#include "bench/report/program.h"
#include "evaluation/paper/paper_experiments.h"

#include <fmt/core.h>

#include <utility>

using namespace sheen::bench;
using namespace sheen::evaluation;

int main(int argc, char** argv) {
  return run_program(
      argc, argv, "The experiments of the IWLS paper on synthetic patches",
      [](const ProgramOptions& options, const Progress& progress) {
        PaperOptions paper;
        paper.seed = options.seed;
        if (options.quick) {
          paper.seeds = 1;
          paper.points_per_material = 2;
        }
        const PaperTables tables = run_paper_experiments(paper, progress);
        for (const auto& [name, table] : {std::pair{"paper_layouts.csv", &tables.layouts},
                                          std::pair{"paper_incremental.csv", &tables.incremental},
                                          std::pair{"paper_fits.csv", &tables.fits},
                                          std::pair{"paper_centers.csv", &tables.centers}}) {
          fmt::print("{}\n", markdown(*table));
          write_csv(options.output / name, *table);
        }
      });
}
