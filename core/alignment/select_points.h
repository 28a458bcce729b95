// SPDX-License-Identifier: MIT
#pragma once

#include "core/alignment/gradient_image.h"
#include "core/mesh/neighbours.h"
#include "core/samples/vertex_view.h"

#include <opencv2/core/types.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace sheen::core {

/// Bounding box, in whole pixels, of the vertices that are not rejected, grown by `margin_px`;
/// nothing when none is left.
std::optional<cv::Rect> visible_region(const VertexView& view, int margin_px);

/// Which vertices can tell a shift of the image.
struct SelectionLimits {
  std::size_t max_points = 1500;  ///< the strongest gradients are taken
  double min_gradient = 0.008;    ///< luma per px; weaker ones are noise
  float silhouette_px = 3;  ///< distance kept from vertices that are rejected: beside them the
                            ///< gradient is that of the background
};

/// Vertices for an alignment: `usable`, not rejected, all vertices within `silhouette_px` along
/// edges of the mesh not rejected either, strongest gradients first served; ascending. The result
/// replaces `selected`.
void select_points(const VertexView& view, const VertexNeighbours& neighbours,
                   const std::vector<std::uint8_t>& usable, const GradientImage& image,
                   const SelectionLimits& limits, std::vector<std::uint32_t>& selected);

}  // namespace sheen::core
