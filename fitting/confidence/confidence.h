// SPDX-License-Identifier: MIT
#pragma once

#include "core/samples/sample_batch.h"
#include "fitting/guidance/direction_cells.h"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <vector>

namespace sheen::fitting {

/// From where every patch was looked at: one set of cells of directions per patch, as the model
/// file keeps it; empty where nobody kept count.
using SeenDirections = std::vector<guidance::DirectionCells>;

/// Marks where a view saw its patches from. Patches of the batch have an entry in `seen`.
void note_seen(const core::SampleBatch& batch, SeenDirections& seen);

/// How far a patch can be trusted towards each of its 8 x 8 cells of directions (cell as in
/// guidance/direction_cells.h), of 255: 255 in cells somebody looked from, 128 one cell away, 26
/// two cells away, 0 beyond: 1 - guidance::predicted_variance.
using ConfidenceCells = std::array<std::uint8_t, guidance::kCellCount>;
ConfidenceCells confidence_cells(guidance::DirectionCells seen);

/// The same towards a direction on the unit disc, in [0, 1], bilinear between the cells' centres.
float confidence_towards(const ConfidenceCells& cells, const Eigen::Vector2f& uv);

}  // namespace sheen::fitting
