// SPDX-License-Identifier: MIT
#include "fitting/confidence/confidence.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace sheen::fitting {

void note_seen(const core::SampleBatch& batch, SeenDirections& seen) {
  for (std::size_t i = 0; i < batch.size(); ++i) {
    assert(batch.patch[i] < seen.size());
    seen[batch.patch[i]] |= guidance::cell_bit(guidance::cell_of({batch.u[i], batch.v[i]}));
  }
}

ConfidenceCells confidence_cells(guidance::DirectionCells seen) {
  ConfidenceCells cells{};
  for (int cell = 0; cell < guidance::kCellCount; ++cell) {
    const float trust = 1.0f - guidance::predicted_variance(seen, cell);
    cells[static_cast<std::size_t>(cell)] = static_cast<std::uint8_t>(std::lround(255.0f * trust));
  }
  return cells;
}

float confidence_towards(const ConfidenceCells& cells, const Eigen::Vector2f& uv) {
  constexpr int side = guidance::kCellsPerSide;
  // Centres of cells lie at halves.
  const auto place = [](float coordinate) {
    return std::clamp((coordinate + 1.0f) * (0.5f * side) - 0.5f, 0.0f, side - 1.0f);
  };
  const float x = place(uv.x());
  const float y = place(uv.y());
  const int left = std::min(static_cast<int>(x), side - 2);
  const int top = std::min(static_cast<int>(y), side - 2);
  const float right = x - static_cast<float>(left);
  const float below = y - static_cast<float>(top);
  const auto at = [&](int column, int row) {
    return static_cast<float>(cells[static_cast<std::size_t>(side * row + column)]) / 255.0f;
  };
  return (1.0f - below) * ((1.0f - right) * at(left, top) + right * at(left + 1, top)) +
         below * ((1.0f - right) * at(left, top + 1) + right * at(left + 1, top + 1));
}

}  // namespace sheen::fitting
