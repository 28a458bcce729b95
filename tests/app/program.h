// SPDX-License-Identifier: MIT
#pragma once

#include "tests/support/temporary_folder.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace sheen::tests {

/// What a run of the program left behind.
struct ProgramRun {
  int exit_code = -1;
  std::string standard_output;
  std::string standard_error;

  [[nodiscard]] nlohmann::json json() const { return nlohmann::json::parse(standard_output); }
};

/// Runs the built `sheen` with these arguments, without a shell, and waits for its end.
ProgramRun run_sheen(const std::vector<std::string>& arguments);

/// Path of the built program.
const char* sheen_program();

/// The recorded session that comes with the source.
std::filesystem::path sample_session();

/// A real recording that is not part of the repository; empty when it is absent.
std::filesystem::path shared_session(const std::string& name);

}  // namespace sheen::tests
