// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sheen::fitting::depth_quads {

/// One level of detail of a photograph: square cells of so many pixels, row by row from the crop's
/// first pixel; the last ones may reach beyond its border.
struct QuadLevel {
  int spacing_px;
  int columns, rows;  ///< ceil(width / spacing), ceil(height / spacing)

  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  }
};

/// The levels of a crop: spacings s, 2 s + 1, ...
std::vector<QuadLevel> quad_levels(const cv::Size& crop, int spacing_px, int levels);

/// How far the quads of a photograph lie behind its pixels. 16 bits each: 0 where there is no quad,
/// else nearest_m + (code - 1) / 65534 * (farthest_m - nearest_m), along the optical axis.
struct QuadDepths {
  float nearest_m = 0;
  float farthest_m = 0;
  std::vector<std::uint16_t> codes;  ///< of all levels, one behind the other

  [[nodiscard]] float depth_m(std::uint16_t code) const {
    constexpr float steps = 65534.0f;
    return nearest_m + static_cast<float>(code - 1) / steps * (farthest_m - nearest_m);
  }
};

/// A quad wherever the pixel in the middle of a cell has a depth: the median of the `median` x
/// `median` depths around it, those that there are. `depth_m` is CV_32FC1, 0 where nothing is.
QuadDepths quad_depths(const cv::Mat& depth_m, std::span<const QuadLevel> levels, int median);

}  // namespace sheen::fitting::depth_quads
