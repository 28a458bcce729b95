// SPDX-License-Identifier: MIT
#include "capture/registration/colour_statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sheen::capture {
namespace {

constexpr std::size_t kBins = std::size_t{1} << 12;
constexpr float kUnseen = 0.02F / kBins;  // probability that keeps unseen colours undecided

void normalise(std::vector<float>& counts) {
  const float sum = std::accumulate(counts.begin(), counts.end(), 0.0F);
  if (!(sum > 0)) return;
  for (float& count : counts) count /= sum;
}

}  // namespace

ColourStatistics::ColourStatistics() : object_(kBins), surroundings_(kBins), evidence_(kBins) {}

void ColourStatistics::add(const cv::Vec3b& bgr, bool on_object) {
  (on_object ? object_ : surroundings_)[bin(bgr)] += 1;
}

void ColourStatistics::finish() {
  normalise(object_);
  normalise(surroundings_);
  for (std::size_t i = 0; i < kBins; ++i) {
    const float ratio = std::log((object_[i] + kUnseen) / (surroundings_[i] + kUnseen));
    evidence_[i] = std::clamp(ratio, -kMostEvidence, kMostEvidence);
  }
}

}  // namespace sheen::capture
