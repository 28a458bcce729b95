// SPDX-License-Identifier: MIT
#include "bench/report/program.h"
#include "evaluation/scene/scene_study.h"
#include "evaluation/scene/scene_tables.h"

#include <fmt/core.h>

using namespace sheen::bench;
using namespace sheen::evaluation;

int main(int argc, char** argv) {
  return run_program(argc, argv, "How much model a whole object needs: 70 % matt, 30 % glossy",
                     [](const ProgramOptions& options, const Progress& progress) {
                       SceneStudyOptions study;
                       study.methods = all_methods();
                       study.seed = options.seed;
                       if (options.quick) {
                         study.sample_counts = {24, 96};
                         study.points = 20;
                         study.points_per_material = 1;
                       }
                       const auto rows = run_scene_study(study, progress);
                       const auto busy = run_busy_study(study, progress);
                       // Store everything, show what can be read.
                       write_csv(options.output / "scene.csv", all_rows(rows));
                       write_csv(options.output / "busy.csv", all_rows(busy));
                       for (const char* environment : {"studio", "busy"}) {
                         fmt::print("{}\n", markdown(psnr_against_samples(rows, environment)));
                         fmt::print("{}\n", markdown(numbers_by_material(rows, environment)));
                       }
                       fmt::print("{}\n", markdown(busy_table(busy)));
                       fmt::print("{}\n", markdown(scene_targets(rows, kDefaultMethod)));
                     });
}
