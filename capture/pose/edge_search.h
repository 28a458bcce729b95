// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/edge_alignment.h"
#include "capture/pose/side_line.h"
#include "capture/pose/tag_view.h"
#include "core/geometry/camera.h"

#include <opencv2/core/mat.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace sheen::capture {

/// Edges of the print found along the outlines of tags in a CV_8UC1 image. Keeps its buffers.
class EdgeSearch {
 public:
  /// A side of a tag as the image shows it.
  struct Side {
    std::size_t view = 0;
    std::size_t side = 0;
    SideOffset offset;                       ///< against the view
    std::array<Eigen::Vector2d, 2> outward;  ///< unit normals near its beginning and its end
  };

  explicit EdgeSearch(const core::CameraModel& camera) : camera_(camera) {}

  /// Coarse: the strongest step of the right sign within so many modules of every outline.
  void find_steps(const cv::Mat& grey, const std::vector<TagView>& views, double reach_modules);

  /// How wide the edges are, for `find_sides`. The outlines must lie within half a pixel. Returns
  /// the same measure as `tag_edge_width`.
  std::optional<double> measure_widths(const cv::Mat& grey, const std::vector<TagView>& views);

  /// Fine: lines through the edges, by profiles just longer than the edges are wide. Covered
  /// stretches do not count, and sides of which less than half is seen are left out.
  void find_sides(const cv::Mat& grey, const std::vector<TagView>& views);

  /// What the last search found: of `find_sides` two observations a side.
  [[nodiscard]] const std::vector<EdgeObservation>& observations() const { return observations_; }
  [[nodiscard]] const std::vector<Side>& sides() const { return sides_; }

 private:
  [[nodiscard]] double share_of(const EdgePoint& edge) const;
  void measure_pair(const cv::Mat& grey, const TagView& view, std::size_t pair);
  [[nodiscard]] EdgePositions measure_side(const cv::Mat& grey, const TagView& view,
                                           std::size_t side,
                                           const std::array<Eigen::Vector2d, 2>& outward,
                                           std::size_t wanted) const;

  core::CameraModel camera_;
  std::vector<EdgeObservation> observations_;
  std::vector<Side> sides_;
  std::array<double, 2> width_px_{};  ///< of the edges of either pair of opposite sides
  std::array<std::vector<double>, 2> pair_widths_px_;
  std::vector<double> tag_widths_px_;
  std::vector<double> room_;
};

}  // namespace sheen::capture
