// SPDX-License-Identifier: MIT
#include "exporters/surface/vertex_confidence.h"

#include <bit>

namespace sheen::exporters {

std::vector<core::VertexConfidence> vertex_confidence(const fitting::Model& model) {
  const fitting::guidance::DirectionCells all = fitting::guidance::disc_cells();
  std::vector<core::VertexConfidence> confidence;
  confidence.reserve(model.seen.size());
  for (const fitting::guidance::DirectionCells seen : model.seen) {
    const float doubt = fitting::guidance::variance_sum(seen, all);
    confidence.push_back({seen, 1.0f - doubt / static_cast<float>(std::popcount(all))});
  }
  return confidence;
}

}  // namespace sheen::exporters
