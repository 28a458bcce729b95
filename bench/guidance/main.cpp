// SPDX-License-Identifier: MIT
#include "bench/report/program.h"
#include "evaluation/guidance/guidance_study.h"

#include <fmt/core.h>

#include <vector>

using namespace sheen::bench;
using namespace sheen::evaluation;

int main(int argc, char** argv) {
  return run_program(argc, argv, "Whether scores rank true errors and hints save frames",
                     [](const ProgramOptions& options, const Progress& progress) {
                       GuidanceStudyOptions study;
                       study.seed = options.seed;
                       if (options.quick) study.scenes = 1;
                       const Table ranking = ranking_table(study, progress);
                       write_csv(options.output / "guidance_ranking.csv", ranking);
                       fmt::print("{}\n", markdown(ranking));
                       // Two sweeps: broken off early, and carried through.
                       std::vector<int> lengths{200};
                       if (!options.quick) lengths.push_back(study.frames);
                       for (const int frames : lengths) {
                         study.frames = frames;
                         const Table walks = walk_table(study, progress);
                         write_csv(options.output / fmt::format("guidance_walks_{}.csv", frames),
                                   walks);
                         fmt::print("{}\n", markdown(walks));
                       }
                     });
}
