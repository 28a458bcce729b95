// SPDX-License-Identifier: MIT
#pragma once

#include "evaluation/study/random.h"

#include <Eigen/Core>

namespace sheen::evaluation {

/// What a camera and its tracking do to samples on their way.
struct Corruption {
  float noise = 0.01f;      ///< standard deviation per channel, display values
  float pose_error = 0.5f;  ///< standard deviation of the direction's error, degrees, per axis
  float outliers = 0;       ///< part of the samples that show something else: any colour
  float exposure = 1;       ///< factor on samples and truth
  bool clamp = true;        ///< samples saturate at [0, 1]
  bool eight_bit = true;    ///< samples are rounded to multiples of 1 / 255
};

/// The direction that tracking reports for `direction` (unit); stays on the hemisphere z > 0.
Eigen::Vector3f with_pose_error(const Eigen::Vector3f& direction, const Corruption& corruption,
                                Random& random);

/// What the camera reports for an exposed `radiance`.
Eigen::Vector3f photographed(const Eigen::Vector3f& radiance, const Corruption& corruption,
                             Random& random);

}  // namespace sheen::evaluation
