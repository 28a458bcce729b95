// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace sheen::evaluation {

/// What lies in the folder afterwards, and a note for each thing that could not be made.
struct ComparisonFiles {
  std::vector<std::filesystem::path> written;
  std::vector<std::string> notes;
};

/// Writes compare.csv, compare.html and the charts (PNG, SVG) to `staging`, then moves them file by
/// file into `folder`; what else lies there stays. `document` is to_json's. Charts need python3
/// with matplotlib, the page Chart.js: where they are missing the rest is written all the same.
/// Throws core::Error (run_failed) when a file cannot be written or moved.
ComparisonFiles write_comparison(const std::filesystem::path& folder,
                                 const std::filesystem::path& staging, const std::string& csv,
                                 const nlohmann::ordered_json& document);

}  // namespace sheen::evaluation
