// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include <vector>

namespace sheen::evaluation {

/// Distant light as a fixed set of directions: what is integrated is exactly this sum, so a
/// lumisphere is an exact function and not an estimate.
struct Environment {
  std::vector<Eigen::Vector3f> direction;  ///< unit, world frame (z up), towards the light
  std::vector<Eigen::Vector3f> power;      ///< radiance x solid angle, linear RGB, sr
};

/// Five area lights of 6 to 15 degrees radius under a gradient sky.
Environment studio_environment();

/// Striped window, 30 small lamps and noise of several scales: reflections without sparse
/// highlights.
Environment busy_environment();

}  // namespace sheen::evaluation
