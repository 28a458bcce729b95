// SPDX-License-Identifier: MIT
#include "fitting/confidence/confidence.h"

#include <gtest/gtest.h>

#include <bit>

namespace sheen::fitting {
namespace {

using guidance::cell_bit;
using guidance::cell_of;
using guidance::centre_of;

TEST(Confidence, NotesTheCellOfEverySample) {
  SeenDirections seen(3, 0);
  core::SampleBatch batch;
  batch.patch = {0, 2};
  batch.u = {0.1f, -0.9f};
  batch.v = {0.1f, 0.2f};
  note_seen(batch, seen);
  note_seen(batch, seen);  // a second look from the same place adds nothing
  EXPECT_EQ(seen[0], cell_bit(cell_of({0.1f, 0.1f})));
  EXPECT_EQ(seen[1], 0u);
  EXPECT_EQ(std::popcount(seen[2]), 1);
}

TEST(Confidence, IsFullWhereSomebodyLookedAndNothingThreeCellsAway) {
  // Cell (3, 3) seen: rings of 1, 8 and 16 cells have 255 x (1, 0.5, 0.1) = 255, 128, 26, the rest
  // 0.
  const ConfidenceCells cells = confidence_cells(cell_bit(8 * 3 + 3));
  for (int row = 0; row < 8; ++row) {
    for (int column = 0; column < 8; ++column) {
      const int ring = std::max(std::abs(row - 3), std::abs(column - 3));
      const int expected = ring == 0 ? 255 : ring == 1 ? 128 : ring == 2 ? 26 : 0;
      EXPECT_EQ(cells[static_cast<std::size_t>(8 * row + column)], expected);
    }
  }
}

TEST(Confidence, IsACellsOwnAtItsCentreAndHalfwayBetweenTwo) {
  const ConfidenceCells cells = confidence_cells(cell_bit(8 * 3 + 3));
  for (int cell = 0; cell < guidance::kCellCount; ++cell) {
    EXPECT_NEAR(confidence_towards(cells, centre_of(cell)),
                static_cast<float>(cells[static_cast<std::size_t>(cell)]) / 255.0f, 1e-6f);
  }
  // Between a seen cell and its neighbour: (255 + 128) / 2 of 255.
  EXPECT_NEAR(confidence_towards(cells, 0.5f * (centre_of(27) + centre_of(28))),
              (255.0f + 128.0f) / 510.0f, 1e-6f);
  // Beyond the outermost centres it goes on as it ends.
  EXPECT_EQ(confidence_towards(cells, {-3.0f, -3.0f}), 0.0f);
}

}  // namespace
}  // namespace sheen::fitting
