// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"
#include "core/samples/observation.h"
#include "core/visibility/depth_image.h"
#include "fitting/option_table.h"

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sheen::fitting {

/// A photograph that a model keeps: the part that may show the object, and where it was taken from.
struct KeptView {
  core::CameraModel camera;              ///< of the whole image, lens distortion included
  Eigen::Isometry3d camera_from_object;  ///< metres
  cv::Rect crop;                         ///< in the camera's image, not empty
  std::vector<std::uint8_t> jpeg;        ///< of the crop

  /// The crop, CV_8UC3 BGR. Throws core::Error (bad_input) when its bytes cannot be decoded.
  [[nodiscard]] cv::Mat pixels() const;
  /// Position of the camera, object frame, metres.
  [[nodiscard]] Eigen::Vector3d eye() const;
};

/// What a kept photograph shows beside the object: what was there, or the object's colours
/// continued, for drawing that reaches a little beyond it.
enum class Surroundings { photographed, continued };

/// Keeps the object's pixels within `depth.box()`, which is not empty, and those beside it; far
/// from it all is grey. `quality` of the JPEG in [1, 100].
KeptView keep_view(const core::Observation& observation, const core::DepthImage& depth, int quality,
                   Surroundings surroundings);

/// How photographs are kept, and how many of them stay decoded while a model is drawn.
struct KeptViewOptions {
  int quality = 95;    ///< of the JPEG, [1, 100]
  int cache_mb = 256;  ///< decoded photographs, at most so many megabytes (10^6 bytes); >= 0
};

/// Adds their options to a representation's table.
void add_options(KeptViewOptions& options, OptionTable& table);
/// Throws std::invalid_argument naming the option and its allowed values.
void check(const KeptViewOptions& options);

}  // namespace sheen::fitting
