// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace sheen::app {

/// Why a session went no further.
struct Failure {
  std::string step;     ///< empty: none could begin
  std::string message;  ///< the program's one line
};

/// By name of the session.
using Failures = std::map<std::string, Failure>;

/// Leaves failed.json in the session's output folder, and what the step said (`log`; may be empty)
/// as failed.log.
void write_failure(const std::filesystem::path& folder, const Failure& failure,
                   const std::filesystem::path& log);
std::optional<Failure> read_failure(const std::filesystem::path& folder);
void remove_failure(const std::filesystem::path& folder);

}  // namespace sheen::app
