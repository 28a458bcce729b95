// SPDX-License-Identifier: MIT
#include "bench/report/program.h"
#include "evaluation/stability/confidence.h"
#include "evaluation/stability/stability_suite.h"
#include "evaluation/stability/stability_tables.h"

#include <fmt/core.h>

using namespace sheen::bench;
using namespace sheen::evaluation;

int main(int argc, char** argv) {
  return run_program(argc, argv, "Where each method fails: few, noisy, one-sided, wrong samples",
                     [](const ProgramOptions& options, const Progress& progress) {
                       const StabilityOptions suite =
                           stability_options(options.seed, options.quick);
                       const auto rows = run_stability(suite, progress);
                       const Table confidence = confidence_study(suite, progress);
                       // Store everything, show what can be read.
                       write_csv(options.output / "stability.csv", all_rows(rows));
                       write_csv(options.output / "monotonicity.csv", monotonicity(rows));
                       write_csv(options.output / "confidence.csv", confidence);
                       for (const Table& table : error_against_samples(rows))
                         fmt::print("{}\n", markdown(table));
                       fmt::print("{}\n", markdown(error_against_settings(rows, ViewSet::uni)));
                       fmt::print("{}\n", markdown(error_against_settings(rows, ViewSet::arc)));
                       fmt::print("{}\n", markdown(extrapolation(rows)));
                       fmt::print("{}\n", markdown(monotonicity(rows)));
                       fmt::print("{}\n", markdown(monotonicity_of(rows, kDefaultMethod)));
                       fmt::print("{}\n", markdown(confidence));
                       fmt::print("{}\n", markdown(stability_targets(rows, kDefaultMethod)));
                     });
}
