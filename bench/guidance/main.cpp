// SPDX-License-Identifier: MIT
#include "bench/guidance/guidance_study.h"

#include <fmt/core.h>

using namespace sheen::bench;

int main(int argc, char** argv) {
  return run_program(argc, argv, "Whether scores rank true errors and hints save frames",
                     [](const ProgramOptions& options, const Progress& progress) {
                       GuidanceStudyOptions study;
                       study.seed = options.seed;
                       if (options.quick) {
                         study.scenes = 1;
                         study.frames = 200;
                       }
                       const Table ranking = ranking_table(study, progress);
                       write_csv(options.output / "guidance_ranking.csv", ranking);
                       fmt::print("{}\n", markdown(ranking));
                       const Table walks = walk_table(study, progress);
                       write_csv(options.output / "guidance_walks.csv", walks);
                       fmt::print("{}\n", markdown(walks));
                     });
}
