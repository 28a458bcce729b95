// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace sheen::evaluation {

/// Runs a program without a shell and waits for its end; `words` are its path and its arguments.
/// What it says on either stream goes to the file `messages`. Returns its exit status (128 + signal
/// when one ended it); nothing when it cannot be started.
std::optional<int> run_program(std::vector<std::string> words,
                               const std::filesystem::path& messages);

}  // namespace sheen::evaluation
