// SPDX-License-Identifier: MIT
#pragma once

#include "reconstruction/views/view_set.h"

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include <cstdint>
#include <vector>

namespace sheen::reconstruction {

/// Where a texel of the stage map comes from.
enum class TexelSource : std::uint8_t { unknown, inpainted, seen };

/// Texels on the plane z = 0 of the board frame: texel (0, 0) has its centre at `first_m`, columns
/// run along x, rows along y.
struct PlaneGrid {
  Eigen::Vector2f first_m{0, 0};
  float texel_m = 0;
  cv::Size size;

  /// Place in texels of a point of the plane.
  [[nodiscard]] Eigen::Vector2f texel_of(const Eigen::Vector2f& point_m) const {
    return (point_m - first_m) / texel_m;
  }
  [[nodiscard]] Eigen::Vector2f point_of(float column, float row) const {
    return first_m + texel_m * Eigen::Vector2f(column, row);
  }
};

/// The stage as it looks without the object, its shadow included: what stands still.
struct StageMap {
  PlaneGrid grid;
  cv::Mat colour;  ///< CV_32FC3, BGR, display-referred, [0, 1], at gain 1
  cv::Mat sigma;   ///< CV_32FC1, spread of the samples over the views
  cv::Mat source;  ///< CV_8UC1, TexelSource
};

/// Exposure of a view: by what it multiplies the map's colours, B, G, R.
using ViewGain = cv::Vec3f;

/// How the samples of a texel are read.
struct MapLearning {
  float mode_share = 0.2F;     ///< of a texel's samples that lie in its shortest interval of luma
  std::vector<cv::Mat> masks;  ///< CV_8UC1 per view, not 0: hides the stage; empty: none known
};

/// A grid over `region` (board frame, metres) whose texels are as large as a pixel on the plane at
/// the region's centre, median over the views; at most `most_texels` of them.
PlaneGrid plane_grid(const ViewSet& views, const Eigen::AlignedBox2f& region, double most_texels);

/// Learns the map: per texel the mean of the samples round the mode of their luma (study, step 1).
/// Texels with fewer than four samples, or that most views do not show free, stay unknown. `gains`
/// has one entry per view.
StageMap learn_stage_map(const ViewSet& views, const std::vector<ViewGain>& gains,
                         const PlaneGrid& grid, const MapLearning& learning, int threads);

/// Exposure of every view against the map, a median over what both show; 1 where too little does.
std::vector<ViewGain> estimate_gains(const ViewSet& views, const StageMap& map,
                                     const std::vector<cv::Mat>& masks, int threads);

}  // namespace sheen::reconstruction
