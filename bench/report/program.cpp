// SPDX-License-Identifier: MIT
#include "bench/report/program.h"

#include "core/diagnostics/error.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <cstdio>

namespace sheen::bench {

int run_program(int argc, char** argv, const std::string& description,
                const std::function<void(const ProgramOptions&, const evaluation::Progress&)>& body,
                const std::function<void(CLI::App&)>& add_options) {
  ProgramOptions options;
  CLI::App app(description);
  app.add_option("-o,--output", options.output, "Folder for CSV files")->capture_default_str();
  app.add_flag("--quick", options.quick, "Fewer points and settings: a check, not a measurement");
  app.add_option("--seed", options.seed, "Seed of points, views and noise")->capture_default_str();
  if (add_options) add_options(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    fmt::print("seed {}{}\n\n", options.seed, options.quick ? ", quick" : "");
    body(options, [](const std::string& line) { fmt::print(stderr, "{}\n", line); });
  } catch (const core::Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return error.kind() == core::Error::Kind::bad_input ? 2 : 1;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}

}  // namespace sheen::bench
