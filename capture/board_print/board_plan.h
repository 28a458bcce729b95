// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board.h"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sheen::capture {

struct Paper {
  std::string_view name;
  double width_mm;
  double height_mm;
};
inline constexpr std::array<Paper, 3> kPapers{
    {{"a4", 210, 297}, {"a3", 297, 420}, {"letter", 215.9, 279.4}}};

/// Families that can be printed: a black square in white paper.
inline constexpr std::array<std::string_view, 4> kPrintableFamilies{"tag36h11", "tag36h10",
                                                                    "tag25h9", "tag16h5"};

/// What a printed board should be.
struct BoardDesign {
  std::string family = "tag36h11";  ///< one of kPrintableFamilies
  Paper paper = kPapers[0];         ///< upright
  double tag_mm = 30;               ///< side of a black square, [5, 250]
  std::optional<int> columns;       ///< of the grid, [1, 60]; none: as many as one sheet holds
  std::optional<int> rows;          ///< likewise
  bool full_grid = false;           ///< tags in the middle too; else round the rim only
  /// Id of the first tag, >= 0; none: 0, and of a default sheet its own (default_board.h).
  std::optional<int> first_id;

  /// Throws std::invalid_argument naming the option and its allowed values.
  void check() const;
};

/// The cells that one sheet of paper holds. Columns count from the left, rows from below.
struct BoardSheet {
  int first_column = 0;
  int columns = 0;
  int first_row = 0;
  int rows = 0;
};

/// A board laid out on paper: a grid of square cells with the board's origin at its centre, tags
/// numbered row by row from the lower left. Sheets are cut half-way between two tags, so that
/// no tag lies on two of them.
struct BoardPlan {
  BoardDesign design;
  int first_id = 0;
  int columns = 0;
  int rows = 0;
  double pitch_mm = 0;             ///< from tag to tag
  double free_width_mm = 0;        ///< of the middle that is left to the object; 0: none
  double free_height_mm = 0;       ///< likewise
  Board board;                     ///< at the size designed
  std::vector<BoardSheet> sheets;  ///< row by row from the upper left, as one lays them out

  /// Id of the tag in a cell; nothing in the free middle.
  [[nodiscard]] std::optional<int> tag_id(int column, int row) const;
};

/// Throws std::invalid_argument for a design that no sheet or family can hold.
BoardPlan plan_board(const BoardDesign& design);

/// White strip at the foot of every sheet for the ruler and the words, and margin elsewhere.
inline constexpr double kFootMm = 27;
inline constexpr double kMarginMm = 10;
/// Length of the ruler on every sheet.
inline constexpr double kRulerMm = 150;

/// Lower left corner of a sheet's block of cells on its paper, mm from the paper's lower left.
std::array<double, 2> block_corner_mm(const BoardPlan& plan, const BoardSheet& sheet);

/// The board as a printer made it whose ruler of kRulerMm is `measured_mm` long.
Board board_as_printed(const Board& board, double measured_mm);

}  // namespace sheen::capture
