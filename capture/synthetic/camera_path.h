// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>

#include <array>
#include <cstdint>

namespace sheen::capture::synthetic {

/// A walk round the object with a camera in hand: a sum of slow waves per degree of freedom, so
/// that it is smooth and the seed alone decides it.
class CameraPath {
 public:
  /// What the walk keeps to; lengths in multiples of the object's radius.
  struct Options {
    double turns = 3;             ///< rounds about the board's z axis
    double lowest_deg = 30;       ///< elevation above the board at the start
    double highest_deg = 60;      ///< and at the end
    double sway_deg = 0;          ///< amplitude of an extra wave of the elevation, twice per round
    double start_deg = 0;         ///< azimuth at the start
    double distance = 5.4;        ///< from the object's centre, mean
    double distance_sway = 0.45;  ///< amplitude of its slow change
    double shake = 1;             ///< strength of the hand's tremor, 0 = a machine's
    std::uint32_t seed = 1;
  };

  CameraPath(const Options& options, const Eigen::Vector3d& centre_in_board, double radius_m);

  /// `t` in [0, 1]. Always looks near the object's centre.
  [[nodiscard]] Eigen::Isometry3d board_from_camera(double t) const;

 private:
  /// Sum of three sines of slow, unrelated frequencies in [-1, 1].
  [[nodiscard]] double wave(int channel, double t) const;

  static constexpr int kChannels = 7;
  Options options_;
  Eigen::Vector3d centre_in_board_;
  double radius_m_;
  std::array<std::array<double, 3>, kChannels> phases_{};
};

/// A walk's recording: a spiral of three rounds upwards through the band of elevations.
CameraPath::Options recording_path(std::uint32_t seed);

/// The views held out: one round that weaves through the same band, within what the recording saw.
CameraPath::Options held_out_path(std::uint32_t seed);

/// As an object on a turntable is seen by a camera that stands still: one round at one elevation,
/// without tremor.
CameraPath::Options turntable_path(double start_deg);

}  // namespace sheen::capture::synthetic
