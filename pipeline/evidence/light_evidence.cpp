// SPDX-License-Identifier: MIT
#include "pipeline/evidence/light_evidence.h"

#include "core/image/srgb_curve.h"
#include "core/numerics/median.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace sheen::pipeline {
namespace {

constexpr std::size_t kMostPatches = 600;
constexpr std::size_t kMostFrames = 128;
constexpr std::size_t kFewestFrames = 8;
constexpr std::size_t kFewestSamples = 20;             // of a frame
constexpr float kDarkest = 0.08F, kBrightest = 0.97F;  // sRGB: below is noise, above is cut off
constexpr int kLightRounds = 8;
constexpr double kOdd = 0.7;    // stops between channels
constexpr double kScale = 0.3;  // stops: what view-dependent patches are off by
constexpr double kRidge =
    0.3;  // samples' worth of trust in patches that look alike from everywhere

// Chosen on bench/stress with seed 1 and the recordings named in docs/stability-sessions.md.
constexpr double kSeenDrift = 0.8;   // stops between the darkest and brightest twentieth of frames
constexpr double kClearDrift = 10;   // times what patches of one frame disagree by
constexpr double kSeenBlob = 0.025;  // of a frame's samples
constexpr std::size_t kFewestHidden = 3;
// Where more suddenly has another colour, poses or mesh are off: what is seen is something else.
constexpr double kFits = 0.1;
constexpr double kNothingFits = 0.28;

float stops_of(float srgb) {
  return std::log2(core::linear_from_srgb(srgb));
}

/// Colour of a patch by direction: constant, u, v; one column per channel.
using PatchColour = Eigen::Matrix3d;

double robust_weight(const Eigen::Vector3d& off) {
  const double ratio2 = off.squaredNorm() / (3 * kScale * kScale);
  return 1 / ((1 + ratio2) * (1 + ratio2));
}

/// Whether a colour is what was expected and white light besides. Both in stops: what is seen, and
/// by how much it exceeds what was expected.
bool is_gloss(const Eigen::Vector3d& seen, const Eigen::Vector3d& excess) {
  constexpr double evenness = 0.5;
  const Eigen::Vector3d expected = seen - excess;
  const Eigen::Array3d added = seen.array().unaryExpr([](double x) { return std::exp2(x); }) -
                               expected.array().unaryExpr([](double x) { return std::exp2(x); });
  return added.minCoeff() > evenness * added.maxCoeff();
}

/// Whether channels are off by different amounts, which neither shade nor exposure makes. False for
/// what is not a number.
bool is_other_colour(const Eigen::Vector3d& off) {
  return off.maxCoeff() - off.minCoeff() > kOdd;
}

/// What groups of patches that are seen under different slopes say alike: an exposure is the same
/// for all of them, a glossy side is not. Nothing where they disagree about the sign.
struct Agreement {
  double value = 0;
  double disagreement = 0;
};
Agreement agreed(const std::vector<std::pair<double, Eigen::Vector3d>>& by_slope,
                 const Eigen::Vector3d& channels) {
  constexpr std::size_t groups = 3;
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (std::size_t group = 0; group < groups; ++group) {
    std::vector<double> values;
    for (std::size_t i = group * by_slope.size() / groups;
         i < (group + 1) * by_slope.size() / groups; ++i) {
      values.push_back(channels.dot(by_slope[i].second));
    }
    const double middle = core::upper_median(values);
    least = std::min(least, middle);
    most = std::max(most, middle);
  }
  return {least > 0 ? least : most < 0 ? most : 0, most - least};
}

/// Whether two colours differ in brightness only, so that they may be of one thing in two lights.
bool is_one_colour(const std::array<float, 3>& a, const std::array<float, 3>& b) {
  constexpr float close = 0.4F;  // stops
  const std::array<float, 3> off{a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  const auto [least, most] = std::minmax_element(off.begin(), off.end());
  return *most - *least < close;
}

/// How many are odd together with most of their nearest neighbours in the image, and
/// of one colour with them.
template <typename Samples>
std::size_t count_surrounded(const Samples& samples, const std::vector<bool>& is_odd) {
  constexpr std::size_t nearest = 8, enough = 5;
  std::size_t surrounded = 0;
  std::vector<std::pair<float, std::size_t>> others;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!is_odd[i]) continue;
    others.clear();
    for (std::size_t j = 0; j < samples.size(); ++j) {
      const float x = samples[j].x_px - samples[i].x_px, y = samples[j].y_px - samples[i].y_px;
      if (j != i) others.emplace_back(x * x + y * y, j);
    }
    if (others.size() < nearest) continue;
    std::nth_element(others.begin(), others.begin() + nearest - 1, others.end());
    std::size_t odd = 0;
    for (std::size_t k = 0; k < nearest; ++k) {
      const std::size_t j = others[k].second;
      odd += is_odd[j] && is_one_colour(samples[i].stops, samples[j].stops) ? 1 : 0;
    }
    surrounded += odd >= enough ? 1 : 0;
  }
  return surrounded;
}

double range(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  return at(0.95) - at(0.05);
}

}  // namespace

LightEvidence::LightEvidence(std::size_t patch_count)
    : spacing_(1 + patch_count / kMostPatches),
      slots_(patch_count / spacing_ + 1),
      frames_(kMostFrames) {}

void LightEvidence::look_at(int frame_index, const core::SampleBatch& samples,
                            const core::VertexView& view) {
  if (!frames_.is_due()) return;
  FrameSamples kept{frame_index, {}};
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples.patch[i] % spacing_ != 0) continue;
    const std::array<float, 3> rgb{samples.r[i], samples.g[i], samples.b[i]};
    const auto [low, high] = std::minmax_element(rgb.begin(), rgb.end());
    if (*low < kDarkest || *high > kBrightest) continue;
    kept.samples.push_back({static_cast<std::uint16_t>(samples.patch[i] / spacing_),
                            samples.u[i],
                            samples.v[i],
                            view.x_px[samples.patch[i]],
                            view.y_px[samples.patch[i]],
                            {stops_of(rgb[0]), stops_of(rgb[1]), stops_of(rgb[2])}});
  }
  frames_.add(std::move(kept));
}

std::vector<Eigen::Matrix3d> LightEvidence::median_colours() const {
  std::vector<std::array<std::vector<double>, 3>> seen(slots_);
  for (const FrameSamples& frame : frames_.items()) {
    for (const Sample& sample : frame.samples) {
      for (std::size_t channel = 0; channel < 3; ++channel) {
        seen[sample.slot][channel].push_back(static_cast<double>(sample.stops[channel]));
      }
    }
  }
  std::vector<PatchColour> colours(slots_, PatchColour::Zero());
  for (std::size_t slot = 0; slot < slots_; ++slot) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      if (seen[slot][channel].empty()) continue;
      colours[slot](0, static_cast<Eigen::Index>(channel)) =
          core::upper_median(seen[slot][channel]);
    }
  }
  return colours;
}

std::vector<LightEvidence::FrameLight> LightEvidence::frames() const {
  const auto& frames = frames_.items();
  std::vector<PatchColour> colours = median_colours();
  std::vector<Eigen::Vector3d> gains(frames.size(), Eigen::Vector3d::Zero());
  const auto stops = [](const Sample& sample) {
    return Eigen::Vector3d(sample.stops[0], sample.stops[1], sample.stops[2]);
  };
  const auto off = [&](std::size_t f, const Sample& sample) -> Eigen::Vector3d {
    return stops(sample) - gains[f] -
           colours[sample.slot].transpose() * Eigen::Vector3d(1, sample.u, sample.v);
  };

  // Patches from the frames' gains, gains from the patches, in turn.
  for (int round = 0; round < kLightRounds; ++round) {
    std::vector<Eigen::Matrix3d> H(slots_, Eigen::Vector3d(1e-6, kRidge, kRidge).asDiagonal());
    std::vector<Eigen::Matrix3d> g(slots_, Eigen::Matrix3d::Zero());
    for (std::size_t f = 0; f < frames.size(); ++f) {
      for (const Sample& sample : frames[f].samples) {
        const Eigen::Vector3d terms(1, sample.u, sample.v);
        const double weight = robust_weight(off(f, sample));
        H[sample.slot] += weight * terms * terms.transpose();
        g[sample.slot] += weight * terms * (stops(sample) - gains[f]).transpose();
      }
    }
    for (std::size_t slot = 0; slot < slots_; ++slot) {
      colours[slot] = H[slot].ldlt().solve(g[slot]);
    }
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (std::size_t f = 0; f < frames.size(); ++f) {
      for (int channel = 0; channel < 3; ++channel) {
        std::vector<double> left;
        for (const Sample& sample : frames[f].samples) left.push_back(off(f, sample)[channel]);
        if (left.size() >= kFewestSamples) gains[f][channel] += core::upper_median(left);
      }
      mean += gains[f] / static_cast<double>(frames.size());
    }
    for (Eigen::Vector3d& gain : gains) gain -= mean;
  }

  // What sets in suddenly is no gloss: seen a frame before or after, the same patch is as expected.
  std::vector<std::vector<Eigen::Vector3d>> left_by_slot(
      frames.size(), std::vector<Eigen::Vector3d>(slots_, Eigen::Vector3d::Constant(NAN)));
  for (std::size_t f = 0; f < frames.size(); ++f) {
    for (const Sample& sample : frames[f].samples) left_by_slot[f][sample.slot] = off(f, sample);
  }
  const auto is_sudden = [&](std::size_t f, const Sample& sample) {
    const Eigen::Vector3d& now = left_by_slot[f][sample.slot];
    const auto differs_from = [&](std::size_t other) {
      return other < frames.size() && is_other_colour(now - left_by_slot[other][sample.slot]);
    };
    return differs_from(f - 1) || differs_from(f + 1);
  };

  std::vector<FrameLight> result;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const auto& samples = frames[f].samples;
    if (samples.size() < kFewestSamples) continue;
    FrameLight light{.frame_index = frames[f].frame_index};
    std::vector<bool> is_odd;
    std::vector<std::pair<double, Eigen::Vector3d>> by_slope;  // of the view, and what is seen
    for (const Sample& sample : samples) {
      const Eigen::Vector3d left = off(f, sample);
      const auto slope = static_cast<double>(std::hypot(sample.u, sample.v));
      is_odd.push_back(is_other_colour(left) && !is_gloss(stops(sample), left) &&
                       is_sudden(f, sample));
      by_slope.emplace_back(slope, left + gains[f]);
    }
    const auto count = static_cast<double>(samples.size());
    light.odd_share = static_cast<double>(std::ranges::count(is_odd, true)) / count;
    light.blob_share = static_cast<double>(count_surrounded(samples, is_odd)) / count;
    std::ranges::sort(by_slope, {}, [](const auto& seen) { return seen.first; });
    const Agreement exposure = agreed(by_slope, {1.0 / 3, 1.0 / 3, 1.0 / 3});
    light.exposure = exposure.value;
    light.disagreement = exposure.disagreement;
    light.balance = agreed(by_slope, {1, 0, -1}).value;
    result.push_back(light);
  }
  return result;
}

LightEvidence::Verdict LightEvidence::verdict() const {
  const std::vector<FrameLight> lights = frames();
  Verdict verdict;
  if (lights.size() < kFewestFrames) return verdict;
  std::vector<double> exposure, balance, disagreement, odd;
  for (const FrameLight& light : lights) {
    odd.push_back(light.odd_share);
    if (light.blob_share > kSeenBlob) verdict.hidden_frames.push_back(light.frame_index);
    if (light.odd_share > kFits) continue;
    exposure.push_back(light.exposure);
    balance.push_back(light.balance);
    disagreement.push_back(light.disagreement);
  }
  verdict.odd_share = core::upper_median(odd);
  if (exposure.size() < kFewestFrames) return verdict;
  verdict.exposure_stops = range(exposure);
  verdict.balance_stops = range(balance);
  verdict.disagreement_stops = core::upper_median(disagreement);
  return verdict;
}

std::vector<Finding> LightEvidence::drifts(const Verdict& verdict) {
  std::vector<Finding> findings;
  const auto is_seen = [&](double stops) {
    return stops > kSeenDrift && stops > kClearDrift * verdict.disagreement_stops;
  };
  if (is_seen(verdict.exposure_stops)) {
    findings.push_back({"exposure-drift",
                        fmt::format("the exposure changes by {:.1f} stops over the recording; lock "
                                    "it in the camera: --exposure takes out a part only",
                                    verdict.exposure_stops)});
  }
  if (is_seen(verdict.balance_stops)) {
    findings.push_back({"white-balance-drift",
                        fmt::format("the white balance changes over the recording, red against "
                                    "blue by {:.1f} stops; lock it in the camera",
                                    verdict.balance_stops)});
  }
  return findings;
}

std::vector<Finding> LightEvidence::contradictions(const Verdict& verdict) {
  if (verdict.odd_share > kNothingFits) {
    return {{"contradiction",
             fmt::format("the views contradict each other on {:.0f} % of the surface: the mesh is "
                         "not of this object, or poses or T_stage_object are wrong; look at sheen "
                         "register --picture",
                         100 * verdict.odd_share)}};
  }
  if (verdict.hidden_frames.size() < kFewestHidden) return {};
  return {{"hidden-object",
           fmt::format("something was before the object, in frame {} and {} others that were "
                       "looked at; keep hands out of the images, or replay with "
                       "--refuse-mismatches",
                       verdict.hidden_frames.front(), verdict.hidden_frames.size() - 1)}};
}

}  // namespace sheen::pipeline
