// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board.h"

#include <array>
#include <cstdint>
#include <vector>

namespace sheen::capture::synthetic {

/// The printed board in the plane z = 0: white paper with tags of the family tag36h11 on the cells
/// of a square grid, the cells in the middle left free for the object, on a dark table.
class BoardPrint {
 public:
  /// Room for an object of the given radius around the origin; the tags grow with it (42 mm tags
  /// for the knot).
  explicit BoardPrint(double object_radius_m);

  [[nodiscard]] const Board& board() const { return board_; }

  /// Half the side of the paper.
  [[nodiscard]] float half_width_m() const { return half_width_m_; }

  /// Diffuse reflectance at (x, y), grey, in [0, 1].
  [[nodiscard]] float reflectance(float x, float y) const;

 private:
  static constexpr int kCells = 7;      ///< per side
  static constexpr int kFreeCells = 3;  ///< per side, in the middle
  static constexpr int kModules = 8;    ///< of the black square, border included
  using Print = std::array<std::array<bool, kModules>,
                           kModules>;  ///< [row from the top][column], true = white

  [[nodiscard]] float paper(float x, float y) const;

  Board board_;
  std::array<int, kCells * kCells>
      print_of_cell_;  ///< index into prints_, -1 = free; rows from below
  std::vector<Print> prints_;
  float tag_m_;
  float pitch_m_;
  float half_width_m_;
};

}  // namespace sheen::capture::synthetic
