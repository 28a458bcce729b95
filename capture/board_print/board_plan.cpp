// SPDX-License-Identifier: MIT
#include "capture/board_print/board_plan.h"

#include "capture/board_print/default_board.h"
#include "capture/pose/tag_family.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sheen::capture {
namespace {

constexpr double kPitchOfTag = 1.25;  // two modules of white between tags of eight
constexpr int kMaxCells = 60;         // per side
constexpr double kSmallestTagMm = 5;
constexpr double kLargestTagMm = 250;

/// Cells of a given pitch in a length; the gap after the last may lie outside.
int cells_within(double length_mm, double tag_mm) {
  const double pitch_mm = kPitchOfTag * tag_mm;
  return static_cast<int>(std::floor((length_mm + pitch_mm - tag_mm) / pitch_mm + 1e-9));
}

void require_range(const char* option, double value, double low, double high) {
  if (value >= low && value <= high) return;
  throw std::invalid_argument(fmt::format("{}: {} is not in [{}, {}]", option, value, low, high));
}

/// Cuts `count` cells into as few parts of at most `most` cells as possible, of nearly equal size.
std::vector<int> split_evenly(int count, int most) {
  const int parts = (count + most - 1) / most;
  std::vector<int> sizes;
  for (int part = 0; part < parts; ++part) {
    sizes.push_back((part + 1) * count / parts - part * count / parts);
  }
  return sizes;
}

std::vector<BoardSheet> split_into_sheets(int columns, int rows, int most_columns, int most_rows) {
  std::vector<BoardSheet> sheets;
  int row = rows;
  for (const int sheet_rows : split_evenly(rows, most_rows)) {
    row -= sheet_rows;
    int column = 0;
    for (const int sheet_columns : split_evenly(columns, most_columns)) {
      sheets.push_back({column, sheet_columns, row, sheet_rows});
      column += sheet_columns;
    }
  }
  return sheets;
}

/// Puts a tag on every cell that is not left free.
void lay_tags(BoardPlan& plan) {
  plan.board.family = plan.design.family;
  for (int row = 0; row < plan.rows; ++row) {
    for (int column = 0; column < plan.columns; ++column) {
      const auto id = plan.tag_id(column, row);
      if (!id) continue;
      Board::Tag tag;
      tag.size_m = plan.design.tag_mm / 1000;
      tag.board_from_tag.translation()
          << (column - (plan.columns - 1) / 2.0) * plan.pitch_mm / 1000,
          (row - (plan.rows - 1) / 2.0) * plan.pitch_mm / 1000, 0;
      plan.board.tags.emplace(*id, tag);
    }
  }
}

}  // namespace

void BoardDesign::check() const {
  if (std::find(kPrintableFamilies.begin(), kPrintableFamilies.end(), family) ==
      kPrintableFamilies.end()) {
    throw std::invalid_argument("family: \"" + family + "\" cannot be printed");
  }
  require_range("tag-mm", tag_mm, kSmallestTagMm, kLargestTagMm);
  if (columns) require_range("columns", *columns, 1, kMaxCells);
  if (rows) require_range("rows", *rows, 1, kMaxCells);
  if (first_id) require_range("first-id", *first_id, 0, 1e6);
}

std::optional<int> BoardPlan::tag_id(int column, int row) const {
  const bool is_inner = column > 0 && column < columns - 1 && row > 0 && row < rows - 1;
  if (design.full_grid) return first_id + row * columns + column;
  if (is_inner) return std::nullopt;
  if (row == 0) return first_id + column;
  if (row == rows - 1) return first_id + columns + std::min(2, columns) * (rows - 2) + column;
  const int before = columns + std::min(2, columns) * (row - 1);
  return first_id + before + (column == 0 ? 0 : 1);
}

BoardPlan plan_board(const BoardDesign& design) {
  design.check();

  // Fit the grid to the paper.
  const int most_columns = cells_within(design.paper.width_mm - 2 * kMarginMm, design.tag_mm);
  const int most_rows = cells_within(design.paper.height_mm - kMarginMm - kFootMm, design.tag_mm);
  if (most_columns < 1 || most_rows < 1) {
    throw std::invalid_argument(
        fmt::format("tag-mm: no tag of {} mm fits on {} paper", design.tag_mm, design.paper.name));
  }
  BoardPlan plan;
  plan.design = design;
  const auto sheet = default_sheet_of(design);
  plan.first_id = design.first_id.value_or(sheet ? sheet->first_id : 0);
  plan.columns = design.columns.value_or(most_columns);
  plan.rows = design.rows.value_or(most_rows);
  plan.pitch_mm = kPitchOfTag * design.tag_mm;
  plan.sheets = split_into_sheets(plan.columns, plan.rows, most_columns, most_rows);

  // Number the tags and note what they leave free.
  lay_tags(plan);
  const int codes = code_count(find_tag_family(design.family, 1).value());
  if (plan.board.tags.rbegin()->first >= codes) {
    throw std::invalid_argument(
        fmt::format("rows, columns: the board needs ids up to {}, the family {} ends at {}",
                    plan.board.tags.rbegin()->first, design.family, codes - 1));
  }
  if (!design.full_grid && plan.columns > 2 && plan.rows > 2) {
    const double gap_mm = plan.pitch_mm - design.tag_mm;
    plan.free_width_mm = (plan.columns - 2) * plan.pitch_mm + gap_mm;
    plan.free_height_mm = (plan.rows - 2) * plan.pitch_mm + gap_mm;
  }
  return plan;
}

std::array<double, 2> block_corner_mm(const BoardPlan& plan, const BoardSheet& sheet) {
  const double width_mm = sheet.columns * plan.pitch_mm;
  const double height_mm = sheet.rows * plan.pitch_mm;
  const double room_mm = plan.design.paper.height_mm - kMarginMm - kFootMm;
  return {(plan.design.paper.width_mm - width_mm) / 2, kFootMm + (room_mm - height_mm) / 2};
}

Board board_as_printed(const Board& board, double measured_mm) {
  const double scale = measured_mm / kRulerMm;
  Board printed = board;
  for (auto& [id, tag] : printed.tags) {
    tag.size_m *= scale;
    tag.board_from_tag.translation() *= scale;
  }
  return printed;
}

}  // namespace sheen::capture
