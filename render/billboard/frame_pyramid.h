// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/billboard/frame.h"

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace sheen::render {

/// A frame ready to be drawn at any size: its image and halves of it (of 5 pixels 2), down to a
/// pixel. Colours are multiplied by their coverage, so that means of pixels are right at outlines.
class FramePyramid {
 public:
  FramePyramid(const fitting::billboard::FrameImage& image, int side_px);

  /// B, G, R times coverage (0 to 255) and coverage (0 to 1) at a place of the frame, between
  /// pixels and levels; nothing beyond its border. Level 0 is the whole image, 1 its half.
  [[nodiscard]] Eigen::Vector4f read(const Eigen::Vector2f& place_px, float level) const;

  /// Depth code at a place, between pixels; beyond what the object covers the nearest one.
  [[nodiscard]] float depth_code(const Eigen::Vector2f& place_px) const;
  /// The same of the nearest pixel; nothing beside the object.
  [[nodiscard]] std::optional<std::uint8_t> surface_code(const Eigen::Vector2f& place_px) const;
  /// Whether something seen in the fit contributes there.
  [[nodiscard]] bool is_supported(const Eigen::Vector2f& place_px) const;

  /// CV_32FC4: what `read` reads.
  [[nodiscard]] const std::vector<cv::Mat>& levels() const { return levels_; }
  [[nodiscard]] std::size_t byte_size() const;

 private:
  [[nodiscard]] Eigen::Vector4f read_level(const Eigen::Vector2f& place_px,
                                           std::size_t level) const;

  float side_px_;
  std::vector<cv::Mat> levels_;
  cv::Point2f crop_px_;  ///< where the shape lies in the frame
  cv::Mat depth_code_;   ///< CV_8UC1 of the crop
  cv::Mat covered_;      ///< CV_8UC1 of the crop, 0 beside the object
  cv::Mat supported_;    ///< CV_8UC1 of the crop
};

}  // namespace sheen::render
