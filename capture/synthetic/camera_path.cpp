// SPDX-License-Identifier: MIT
#include "capture/synthetic/camera_path.h"

#include "capture/synthetic/hash.h"

#include <cmath>
#include <numbers>

namespace sheen::capture::synthetic {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kTwoPi = 2 * std::numbers::pi;

// Amplitudes of the tremor at strength 1; lengths over the object's radius.
constexpr double kAimShake = 0.13;
constexpr double kAzimuthShakeDeg = 2.5;
constexpr double kElevationShakeDeg = 2.0;
constexpr double kRollShakeDeg = 4.0;

/// Camera at `eye` that looks at `target`, its image upright and then rolled.
Eigen::Isometry3d looking_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target,
                             double roll_rad) {
  const Eigen::Vector3d forward = (target - eye).normalized();
  const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Isometry3d board_from_camera = Eigen::Isometry3d::Identity();
  board_from_camera.linear() << right, forward.cross(right), forward;
  board_from_camera.translation() = eye;
  return board_from_camera * Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitZ());
}

}  // namespace

CameraPath::CameraPath(const Options& options, const Eigen::Vector3d& centre_in_board,
                       double radius_m)
    : options_(options), centre_in_board_(centre_in_board), radius_m_(radius_m) {
  for (std::uint32_t channel = 0; channel < kChannels; ++channel) {
    for (std::uint32_t i = 0; i < 3; ++i) {
      const float turn = unit_float(hash(options.seed, channel, i));
      phases_[channel][i] = kTwoPi * static_cast<double>(turn);
    }
  }
}

double CameraPath::wave(int channel, double t) const {
  // Per round of the walk: one slow wave and two faster, weaker ones.
  constexpr std::array<double, 3> frequencies{0.73, 1.91, 4.37};
  constexpr std::array<double, 3> weights{0.55, 0.30, 0.15};
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    sum += weights[i] * std::sin(kTwoPi * frequencies[i] * options_.turns * t +
                                 phases_[static_cast<std::size_t>(channel)][i]);
  }
  return sum;
}

Eigen::Isometry3d CameraPath::board_from_camera(double t) const {
  // Walk: azimuth, elevation and distance.
  const double shake = options_.shake;
  const double azimuth = kDegree * (options_.start_deg + 360 * options_.turns * t +
                                    shake * kAzimuthShakeDeg * wave(0, t));
  const double elevation =
      kDegree * (options_.lowest_deg + (options_.highest_deg - options_.lowest_deg) * t +
                 options_.sway_deg * std::sin(2 * kTwoPi * options_.turns * t) +
                 shake * kElevationShakeDeg * wave(1, t));
  const double distance = radius_m_ * (options_.distance + options_.distance_sway * wave(2, t));
  const Eigen::Vector3d outward(std::cos(elevation) * std::cos(azimuth),
                                std::cos(elevation) * std::sin(azimuth), std::sin(elevation));

  // Aim: near the centre, nearly upright.
  const Eigen::Vector3d miss =
      radius_m_ * kAimShake * shake * Eigen::Vector3d(wave(3, t), wave(4, t), wave(5, t));
  return looking_at(centre_in_board_ + distance * outward, centre_in_board_ + miss,
                    kDegree * kRollShakeDeg * shake * wave(6, t));
}

CameraPath::Options recording_path(std::uint32_t seed) {
  CameraPath::Options options;
  options.seed = seed;
  return options;
}

CameraPath::Options held_out_path(std::uint32_t seed) {
  CameraPath::Options options;
  options.turns = 1;
  options.lowest_deg = 45;
  options.highest_deg = 45;
  options.sway_deg = 11;
  options.start_deg = 17;
  options.seed = hash(seed, 0x5eedU);
  return options;
}

CameraPath::Options turntable_path(double start_deg) {
  constexpr double elevation_deg = 20;
  CameraPath::Options options;
  options.turns = 1;
  options.lowest_deg = options.highest_deg = elevation_deg;
  options.start_deg = start_deg;
  options.distance_sway = 0;
  options.shake = 0;
  return options;
}

}  // namespace sheen::capture::synthetic
