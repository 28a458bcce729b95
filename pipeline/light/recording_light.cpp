// SPDX-License-Identifier: MIT
#include "pipeline/light/recording_light.h"

#include "core/numerics/median.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ranges>

namespace sheen::pipeline {
namespace {

using PaperByTag = std::map<int, Eigen::Vector3d>;
using Gains = std::vector<Eigen::Vector3d>;  // of frames, RGB

constexpr std::size_t kFewestTags = 2;
constexpr std::size_t kFewestFrames = 6;
constexpr int kRounds = 20;
constexpr double kFine_stops = 0.005;  // differences below it count as squares
constexpr double kRidge = 1e-9;        // on gains
// A blur of 2 px looks like .17 stops. Tags of one photograph from a phone, which treats every part
// of a picture in its own way, disagree by a fifth of what such photographs differ by; levelling
// those gains nothing (docs/stability-sessions.md).
constexpr double kClearChange_stops = 0.25;
constexpr double kClearOfDisagreement = 10;

Eigen::Vector3d median_by_channel(std::span<const Eigen::Vector3d> colours) {
  Eigen::Vector3d medians;
  for (Eigen::Index channel = 0; channel < 3; ++channel) {
    std::vector<double> values;
    for (const Eigen::Vector3d& colour : colours) values.push_back(colour[channel]);
    medians[channel] = core::upper_median(values);
  }
  return medians;
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
    for (const capture::PaperLight& light : lights) column.emplace(light.tag_id, 0);
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

PaperByTag usual_light(std::span<const std::vector<capture::PaperLight>> frames) {
  PaperByTag usual;
  for (Eigen::Index channel = 0; channel < 3; ++channel) {
    for (const auto& [tag, stops] : usual_stops(frames, channel)) {
      usual[tag][channel] = std::exp2(stops);
    }
  }
  return usual;
}

LightChange change_of(const Gains& gains) {
  const auto range = [&](const auto& value_of) {
    const auto [least, most] = std::ranges::minmax(gains | std::views::transform(value_of));
    return most - least;
  };
  const auto stops = [](const Eigen::Vector3d& gain) {
    return gain.array().log2().matrix().eval();
  };
  LightChange change;
  change.exposure_stops = range([&](const auto& gain) { return stops(gain).mean(); });
  change.balance_stops = range([&](const auto& gain) { return std::log2(gain[0] / gain[2]); });
  for (Eigen::Index channel = 0; channel < 3; ++channel) {
    change.most_stops = std::max(change.most_stops,
                                 range([&](const auto& gain) { return std::log2(gain[channel]); }));
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
      const double expected = usual.at(light.tag_id).y() * gains[f].y();
      off.push_back(std::abs(std::log2(light.rgb.y() / expected)));
    }
    by_frame.push_back(core::upper_median(off));
  }
  return core::upper_median(by_frame);
}

}  // namespace

std::optional<Eigen::Vector3d> gain_of(std::span<const capture::PaperLight> lights,
                                       const std::map<int, Eigen::Vector3d>& usual) {
  std::array<std::vector<double>, 3> ratios;
  for (const capture::PaperLight& light : lights) {
    const auto known = usual.find(light.tag_id);
    if (known == usual.end()) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto channel = static_cast<Eigen::Index>(c);
      ratios[c].push_back(light.rgb[channel] / known->second[channel]);
    }
  }
  if (ratios[0].size() < kFewestTags) return std::nullopt;
  return Eigen::Vector3d(core::upper_median(ratios[0]), core::upper_median(ratios[1]),
                         core::upper_median(ratios[2]));
}

std::optional<RecordingLight> solve_light(
    std::span<const std::vector<capture::PaperLight>> frames) {
  std::vector<std::vector<capture::PaperLight>> telling(frames.begin(), frames.end());
  std::erase_if(telling, [](const auto& lights) { return lights.size() < kFewestTags; });
  if (telling.size() < kFewestFrames) return std::nullopt;
  PaperByTag usual = usual_light(telling);
  Gains gains;
  for (const auto& lights : telling) gains.push_back(*gain_of(lights, usual));

  // Of all that explain the same, the one whose middle frame is as it is.
  const Eigen::Vector3d middle = median_by_channel(gains);
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
