// SPDX-License-Identifier: MIT
#include "capture/registration/colour_statistics.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace sheen::capture {
namespace {

constexpr float kUnseen = 0.02F / 4096;  // probability that keeps unseen colours undecided

void normalise(std::vector<float>& counts) {
  const float sum = std::accumulate(counts.begin(), counts.end(), 0.0F);
  if (!(sum > 0)) return;
  for (float& count : counts) count /= sum;
}

}  // namespace

ColourStatistics::ColourStatistics() : object_(kBins), surroundings_(kBins), evidence_(kBins) {}

void ColourStatistics::add(const cv::Vec3b& bgr, bool on_object) {
  const std::size_t bin = fine_bin(bgr);
  is_grey_ &= bin >= kColours;
  (on_object ? object_ : surroundings_)[bin] += 1;
}

/// Shades of grey among colours are colours like any other.
void ColourStatistics::fold_greys(std::vector<float>& counts) {
  for (std::size_t shade = kColours; shade < kBins; ++shade) {
    const auto level = static_cast<std::uint8_t>((shade - kColours) << (8 - kGreyBits));
    counts[bin({level, level, level})] += counts[shade];
    counts[shade] = 0;
  }
}

void ColourStatistics::finish() {
  if (!is_grey_) {
    fold_greys(object_);
    fold_greys(surroundings_);
  }
  normalise(object_);
  normalise(surroundings_);
  for (std::size_t i = 0; i < kBins; ++i) {
    const float ratio = std::log((object_[i] + kUnseen) / (surroundings_[i] + kUnseen));
    evidence_[i] = std::clamp(ratio, -kMostEvidence, kMostEvidence);
  }
}

}  // namespace sheen::capture
