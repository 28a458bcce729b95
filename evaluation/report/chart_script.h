// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace sheen::evaluation {

/// Runs a Python script that draws charts (PNG, SVG) of `csv` into `folder`. Nothing when all went
/// well, else a note that says what is missing: python3, matplotlib (exit status 3), or the
/// script's last word.
std::optional<std::string> draw_charts(const std::string& script, const std::filesystem::path& csv,
                                       const std::filesystem::path& folder);

}  // namespace sheen::evaluation
