// SPDX-License-Identifier: MIT
// Where whole sessions fail: docs/stability-sessions.md.
#include "bench/report/program.h"
#include "core/files/write_file.h"
#include "evaluation/stress/stress_study.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

using namespace sheen::bench;
using namespace sheen::evaluation;

int main(int argc, char** argv) {
  std::vector<std::string> only;
  std::filesystem::path json;
  StressOptions stress;
  const auto add_options = [&](CLI::App& app) {
    app.add_option("--only", only, "Kinds of damage, by name; all when not given");
    app.add_option("--json", json, "File for all figures, notes and refusals");
    app.add_option("--frames", stress.frames, "Images of the undamaged recording, on the same walk")
        ->check(CLI::Range(5, 2000))
        ->capture_default_str();
  };
  return run_program(
      argc, argv, "Where whole sessions fail, and whether the program says so",
      [&](const ProgramOptions& options, const Progress& progress) {
        stress.seed = static_cast<std::uint32_t>(options.seed);
        if (options.quick) {
          stress.vertices = 500;
          stress.frames = std::min(stress.frames, 8);
          stress.held_out = 2;
          stress.samples = 1;
          if (only.empty()) only = {"mesh-scale"};
        }
        const auto rows = run_stress(stress, only, options.output, progress);
        write_csv(options.output / "stress.csv", stress_table(rows));
        write_csv(options.output / "stress_limits.csv", stress_limits(rows));
        if (!json.empty()) sheen::core::write_file(json, to_json(rows).dump(2) + "\n");
        fmt::print("{}\n{}\n", markdown(stress_table(rows)), markdown(stress_limits(rows)));
      },
      add_options);
}
