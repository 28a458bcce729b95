// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/tag_family.h"

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include <array>
#include <memory>
#include <vector>

namespace sheen::capture {

/// One tag as a detector saw it.
struct TagDetection {
  int id = 0;
  /// Corners of the black square: lower left, lower right, upper right, upper left of the tag as
  /// printed (the order of Board::Tag::corners_in_board). Pixel (0, 0) is the first pixel's centre.
  std::array<Eigen::Vector2d, 4> corners_px;
  double quality = 0;  ///< larger is surer; comparable within one family only
};

/// Finds the tags of one family in 8-bit images. Move-only; one thread at a time.
class TagDetector {
 public:
  /// Codes of libapriltag's families are corrected by up to `corrected_bits`: more than two need
  /// hundreds of megabytes of tables and invent tags, two need a gigabyte and ten seconds for the
  /// largest families.
  explicit TagDetector(const TagFamily& family, int corrected_bits = 2);
  ~TagDetector();
  TagDetector(const TagDetector&) = delete;
  TagDetector& operator=(const TagDetector&) = delete;
  TagDetector(TagDetector&&) noexcept;
  TagDetector& operator=(TagDetector&&) noexcept;

  /// Everything that decodes, sorted by id, the same id as often as it is seen. `grey` is CV_8UC1.
  [[nodiscard]] std::vector<TagDetection> detect(const cv::Mat& grey) const;

 private:
  class Implementation;
  class AprilTag;
  class Aruco;
  std::unique_ptr<Implementation> implementation_;
};

/// Keeps at most one detection per id: the one whose quality is twice that of every other, else
/// none, since a wrong tag costs more than a missing one. Input and output are sorted by id.
std::vector<TagDetection> drop_ambiguous(const std::vector<TagDetection>& detections);

}  // namespace sheen::capture
