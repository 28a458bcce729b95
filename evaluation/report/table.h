// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sheen::evaluation {

/// A table of results: shown as markdown, stored as CSV.
struct Table {
  std::string title;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  ///< as many cells as columns
};

/// Title as a heading, then an aligned table; the first column left, the others right.
std::string markdown(const Table& table);

/// Header line and rows; cells with commas are quoted. Written aside and moved into place. Throws
/// core::Error.
void write_csv(const std::filesystem::path& path, const Table& table);

/// Fixed decimals, as tables show numbers.
std::string decimals(double value, int count);

/// Whether a target was met, as tables say it.
std::string verdict(bool met);

}  // namespace sheen::evaluation
