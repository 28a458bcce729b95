// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/paper_light.h"

#include <Eigen/Core>

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace sheen::pipeline {

/// What a frame's exposure and white balance multiply light with, against the usual light of the
/// paper: RGB, > 0, the median over the tags that both know and that are not saturated; where all
/// are, the most of the gains that they tell at least. No value for fewer than two of them.
std::optional<Eigen::Vector3d> gain_of(std::span<const capture::PaperLight> lights,
                                       const std::map<int, Eigen::Vector3d>& usual);

/// How far frames depart from each other: ranges, in stops.
struct LightChange {
  double exposure_stops = 0;  ///< of all channels together
  double balance_stops = 0;   ///< of red against blue
  double most_stops = 0;      ///< of the channel that changes most
};

/// Light of a recording's frames by the paper around the tags.
struct RecordingLight {
  std::map<int, Eigen::Vector3d> usual;  ///< by tag, RGB, linear
  LightChange change;
  double disagreement_stops = 0;  ///< of a frame's tags with each other, median
};

/// Solves for a light per tag and a gain per frame and channel by least absolute differences; the
/// median gain is 1. No value for fewer than six frames with two tags.
std::optional<RecordingLight> solve_light(std::span<const std::vector<capture::PaperLight>> frames);

/// Whether frames differ by more than blur makes them seem to, and by clearly more than the tags of
/// a frame do.
bool clearly_changes(const RecordingLight& light);

/// "the exposure changes by 1.0 stops over the recording, the white balance, red against blue, by
/// 0.4"
std::string describe(const LightChange& change);

}  // namespace sheen::pipeline
