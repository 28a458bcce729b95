// SPDX-License-Identifier: MIT
#pragma once

#include "core/alignment/gradient_image.h"
#include "core/geometry/camera.h"

#include <Eigen/Geometry>

#include <optional>
#include <vector>

namespace sheen::core {

/// Points of a surface with the brightness a model expects in the image to be aligned. Structure
/// of arrays, all of the same length.
struct ExpectedPoints {
  std::vector<Eigen::Vector3f> position;  ///< object frame, metres
  std::vector<float> luma;                ///< expected, [0, 1]
  std::vector<float> weight;              ///< trust, >= 0

  [[nodiscard]] std::size_t size() const { return position.size(); }
  void clear() {
    position.clear();
    luma.clear();
    weight.clear();
  }
};

/// How an alignment runs and when it is believed.
struct AlignmentLimits {
  int iterations = 6;                ///< Gauss-Newton steps per level, >= 1
  double coarse_from_px = 1.0;       ///< a first step longer than this is taken on a coarser image
  double coarse_smoothing_px = 3.0;  ///< smoothing of that image
  double prior_px = 0.3;             ///< expected mean error of the start, in the image, > 0
  /// Independent residuals per point: neighbours share pixels and the model's errors, (0, 1].
  double share = 0.01;
  double max_motion_px = 3.0;       ///< a mean motion of the points beyond this is refused
  double max_uncertainty_px = 0.5;  ///< predicted standard deviation of that motion, likewise
  std::size_t min_points = 150;     ///< fewer points in the image are refused
};

/// A pose under which the image agrees better with what was expected.
struct Alignment {
  Eigen::Isometry3d camera_from_object = Eigen::Isometry3d::Identity();
  double gain = 1;            ///< image / expectation, of display-referred luma
  double motion_px = 0;       ///< mean distance the points moved in the image
  double uncertainty_px = 0;  ///< predicted standard deviation of the same
  double rms_before = 0;      ///< robust residual (Huber), luma, at the start with its best gain
  double rms_after = 0;       ///< the same at the end
};

/// Photometric alignment: Gauss-Newton on Huber residuals `image(project(T p)) - gain * luma`
/// over a twist of the pose about the points' centre and the gain. `image` holds the region
/// around the object. A weak prior keeps directions that the points do not tell at the start.
/// Nothing unless the residual falls and the limits hold, so that a bad model cannot spoil a good
/// pose. One thread: the result is always the same.
std::optional<Alignment> align_pose(const ExpectedPoints& points, const GradientImage& image,
                                    const CameraModel& camera,
                                    const Eigen::Isometry3d& camera_from_object,
                                    const AlignmentLimits& limits);

}  // namespace sheen::core
