// SPDX-License-Identifier: MIT
#pragma once

#include "evaluation/report/progress.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace CLI {
class App;
}

namespace sheen::bench {

/// What every program of the bench understands.
struct ProgramOptions {
  std::filesystem::path output = "out/bench";  ///< folder for CSV files
  bool quick = false;                          ///< fewer points and settings: seconds, for tests
  std::uint64_t seed = 1;
};

/// Parses the arguments, calls `body` and turns exceptions into exit codes: 0 done, 1 failed while
/// running, 2 bad arguments. Progress goes to stderr. `add_options` declares what else a program
/// understands.
int run_program(int argc, char** argv, const std::string& description,
                const std::function<void(const ProgramOptions&, const evaluation::Progress&)>& body,
                const std::function<void(CLI::App&)>& add_options = {});

}  // namespace sheen::bench
