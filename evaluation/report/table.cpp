// SPDX-License-Identifier: MIT
#include "evaluation/report/table.h"

#include "core/files/write_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <cassert>

namespace sheen::evaluation {
namespace {

std::string quoted(const std::string& cell) {
  return cell.find(',') == std::string::npos ? cell : fmt::format("\"{}\"", cell);
}

std::string csv_line(const std::vector<std::string>& cells) {
  std::string line;
  for (const std::string& cell : cells) {
    if (!line.empty()) line += ',';
    line += quoted(cell);
  }
  return line + '\n';
}

std::string markdown_line(const std::vector<std::string>& cells,
                          const std::vector<std::size_t>& widths) {
  std::string line = "|";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    line += i == 0 ? fmt::format(" {:<{}} |", cells[i], widths[i])
                   : fmt::format(" {:>{}} |", cells[i], widths[i]);
  }
  return line + '\n';
}

}  // namespace

std::string markdown(const Table& table) {
  // Measure the columns.
  std::vector<std::size_t> widths;
  for (const std::string& column : table.columns) {
    widths.push_back(std::max<std::size_t>(3, column.size()));
  }
  for (const auto& row : table.rows) {
    assert(row.size() == widths.size());
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  // Write them.
  std::string text = fmt::format("### {}\n\n", table.title) + markdown_line(table.columns, widths);
  text += '|';
  for (std::size_t i = 0; i < widths.size(); ++i) {
    text += std::string(widths[i] + 1, '-') + (i == 0 ? "-|" : ":|");
  }
  text += '\n';
  for (const auto& row : table.rows) text += markdown_line(row, widths);
  return text;
}

void write_csv(const std::filesystem::path& path, const Table& table) {
  std::string text = csv_line(table.columns);
  for (const auto& row : table.rows) text += csv_line(row);
  core::write_file(path, text);
}

std::string decimals(double value, int count) {
  return fmt::format("{:.{}f}", value, count);
}

std::string verdict(bool met) {
  return met ? "met" : "missed";
}

}  // namespace sheen::evaluation
