// SPDX-License-Identifier: MIT
#include "pipeline/light/recording_light.h"

#include "core/numerics/median.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace sheen::pipeline {
namespace {

using PaperByTag = std::map<int, Eigen::Vector3d>;
using Gains = std::vector<Eigen::Vector3d>;  // of frames, RGB

constexpr std::size_t kFewestTags = 2;
constexpr std::size_t kFewestFrames = 6;
constexpr int kRounds = 20;
constexpr double kFine_stops = 0.005;  // differences below it count as squares
constexpr double kRidge = 1e-9;        // on gains
constexpr double kSaturated = 0.97;    // light, above which a code tells a least value only
// A blur of 2 px looks like .17 stops. Tags of one photograph from a phone, which treats every part
// of a picture in its own way, disagree by a fifth of what such photographs differ by; levelling
// those gains nothing (docs/stability-sessions.md).
constexpr double kClearChange_stops = 0.25;
constexpr double kClearOfDisagreement = 10;

/// By channel: half of the frames have more, half less; of two in the middle the geometric mean, or
/// every second recording would end brighter than it is.
Eigen::Vector3d middle_gain(const Gains& gains) {
  Eigen::Vector3d middle;
  for (Eigen::Index channel = 0; channel < 3; ++channel) {
    std::vector<double> values;
    for (const Eigen::Vector3d& gain : gains) values.push_back(gain[channel]);
    std::ranges::sort(values);
    const std::size_t last = values.size() - 1;
    middle[channel] = std::sqrt(values[last / 2] * values[(last + 1) / 2]);
  }
  return middle;
}

/// Solves stops = gain of the frame + light of the tag for the tags' light, one channel, by least
/// absolute differences (least squares, reweighted): a shadow on some tags of a frame counts for
/// nothing. Of frames that share no tag, directly or by way of others, nothing is known of each
/// other: the mean gain of either is none.
std::map<int, double> usual_stops(std::span<const std::vector<capture::PaperLight>> frames,
                                  Eigen::Index channel) {
  // Unknowns: frames first, then tags.
  std::map<int, Eigen::Index> column;
  for (const auto& lights : frames) {
    for (const capture::PaperLight& light : lights) {
      if (light.rgb[channel] < kSaturated) column.emplace(light.tag_id, 0);
    }
  }
  auto unknowns = static_cast<Eigen::Index>(frames.size());
  for (auto& [tag, at] : column) at = unknowns++;

  Eigen::VectorXd x = Eigen::VectorXd::Zero(unknowns);
  for (int round = 0; round < kRounds; ++round) {
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(unknowns, unknowns);
    H.diagonal().head(static_cast<Eigen::Index>(frames.size())).setConstant(kRidge);
    Eigen::VectorXd g = Eigen::VectorXd::Zero(unknowns);
    for (std::size_t f = 0; f < frames.size(); ++f) {
      for (const capture::PaperLight& light : frames[f]) {
        if (light.rgb[channel] >= kSaturated) continue;
        const auto i = static_cast<Eigen::Index>(f), j = column.at(light.tag_id);
        const double stops = std::log2(light.rgb[channel]);
        const double off = std::abs(stops - x[i] - x[j]);
        const double weight = round == 0 ? 1 : kFine_stops / std::max(off, kFine_stops);
        H(i, i) += weight;
        H(j, j) += weight;
        H(i, j) += weight;
        H(j, i) += weight;
        g[i] += weight * stops;
        g[j] += weight * stops;
      }
    }
    x = H.ldlt().solve(g);
  }
  std::map<int, double> usual;
  for (const auto& [tag, at] : column) usual[tag] = x[at];
  return usual;
}

/// Of the tags that are seen in all channels.
PaperByTag usual_light(std::span<const std::vector<capture::PaperLight>> frames) {
  const std::array by_channel{usual_stops(frames, 0), usual_stops(frames, 1),
                              usual_stops(frames, 2)};
  PaperByTag usual;
  for (const auto& [tag, stops] : by_channel[0]) {
    if (!by_channel[1].contains(tag) || !by_channel[2].contains(tag)) continue;
    usual[tag] = {std::exp2(stops), std::exp2(by_channel[1].at(tag)),
                  std::exp2(by_channel[2].at(tag))};
  }
  return usual;
}

LightChange change_of(const Gains& gains) {
  const auto range = [&](const auto& value_of) {
    std::vector<double> values;
    for (const Eigen::Vector3d& gain : gains)
      values.push_back(value_of(gain.array().log2().eval()));
    const auto [least, most] = std::ranges::minmax(values);
    return most - least;
  };
  LightChange change;
  change.exposure_stops = range([](const Eigen::Array3d& stops) { return stops.mean(); });
  change.balance_stops = range([](const Eigen::Array3d& stops) { return stops[0] - stops[2]; });
  for (Eigen::Index channel = 0; channel < 3; ++channel) {
    change.most_stops = std::max(
        change.most_stops, range([&](const Eigen::Array3d& stops) { return stops[channel]; }));
  }
  return change;
}

/// What a frame's tags differ by, green, in the usual frame.
double disagreement_of(std::span<const std::vector<capture::PaperLight>> frames, const Gains& gains,
                       const PaperByTag& usual) {
  std::vector<double> by_frame;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    std::vector<double> off;
    for (const capture::PaperLight& light : frames[f]) {
      const auto known = usual.find(light.tag_id);
      if (known == usual.end() || light.rgb.y() >= kSaturated) continue;
      off.push_back(std::abs(std::log2(light.rgb.y() / (known->second.y() * gains[f].y()))));
    }
    if (!off.empty()) by_frame.push_back(core::upper_median(off));
  }
  return by_frame.empty() ? 0 : core::upper_median(by_frame);
}

}  // namespace

std::optional<Eigen::Vector3d> gain_of(std::span<const capture::PaperLight> lights,
                                       const std::map<int, Eigen::Vector3d>& usual) {
  Eigen::Vector3d gain;
  for (Eigen::Index channel = 0; channel < 3; ++channel) {
    std::vector<double> ratios, least;
    for (const capture::PaperLight& light : lights) {
      const auto known = usual.find(light.tag_id);
      if (known == usual.end()) continue;
      const double ratio = light.rgb[channel] / known->second[channel];
      (light.rgb[channel] < kSaturated ? ratios : least).push_back(ratio);
    }
    if (ratios.size() + least.size() < kFewestTags) return std::nullopt;
    // Saturated paper tells a least gain, which is better than none.
    const bool tells = ratios.size() >= kFewestTags;
    gain[channel] = tells ? core::upper_median(ratios) : *std::ranges::max_element(least);
  }
  return gain;
}

std::optional<RecordingLight> solve_light(
    std::span<const std::vector<capture::PaperLight>> frames) {
  PaperByTag usual = usual_light(frames);
  std::vector<std::vector<capture::PaperLight>> telling;
  Gains gains;
  for (const auto& lights : frames) {
    const auto gain = gain_of(lights, usual);
    if (!gain) continue;
    telling.push_back(lights);
    gains.push_back(*gain);
  }
  if (telling.size() < kFewestFrames) return std::nullopt;

  // Of all that explain the same, the one whose middle frame is as it is.
  const Eigen::Vector3d middle = middle_gain(gains);
  for (auto& [tag, rgb] : usual) rgb = rgb.cwiseProduct(middle);
  for (Eigen::Vector3d& gain : gains) gain = gain.cwiseQuotient(middle);
  return RecordingLight{usual, change_of(gains), disagreement_of(telling, gains, usual)};
}

bool clearly_changes(const RecordingLight& light) {
  const double stops = light.change.most_stops;
  return stops > kClearChange_stops && stops > kClearOfDisagreement * light.disagreement_stops;
}

std::string describe(const LightChange& change) {
  return fmt::format(
      "the exposure changes by {:.1f} stops over the recording, the white balance, red against "
      "blue, by {:.1f}",
      change.exposure_stops, change.balance_stops);
}

}  // namespace sheen::pipeline
