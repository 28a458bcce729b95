// SPDX-License-Identifier: MIT
#include "fitting/eigen_texture/merging_views.h"

#include <limits>
#include <utility>

namespace sheen::fitting::eigen_texture {
namespace {

SeenTexel mean_of(const SeenTexel& a, const SeenTexel& b, float share) {
  const auto between = [](std::uint8_t x, std::uint8_t y, float part) {
    return static_cast<std::uint8_t>((1.0f - part) * static_cast<float>(x) +
                                     part * static_cast<float>(y) + 0.5f);
  };
  // Colours by what each counts for, too.
  const float weight_b = share * static_cast<float>(b.weight);
  const float part = weight_b / ((1.0f - share) * static_cast<float>(a.weight) + weight_b);
  SeenTexel mean{a.slot, {}, between(a.weight, b.weight, share)};
  for (std::size_t c = 0; c < 3; ++c) mean.rgb[c] = between(a.rgb[c], b.rgb[c], part);
  return mean;
}

}  // namespace

std::vector<SeenTexel> merged(const std::vector<SeenTexel>& first,
                              const std::vector<SeenTexel>& second, float share) {
  std::vector<SeenTexel> both;
  both.reserve(first.size() + second.size() / 4);
  auto a = first.begin();
  auto b = second.begin();
  while (a != first.end() || b != second.end()) {
    if (b == second.end() || (a != first.end() && a->slot < b->slot)) {
      both.push_back(*a++);
    } else if (a == first.end() || b->slot < a->slot) {
      both.push_back(*b++);
    } else {
      both.push_back(mean_of(*a++, *b++, share));
    }
  }
  return both;
}

void MergingViews::add(std::vector<SeenTexel> texels, const Eigen::Vector3f& direction) {
  texels_.push_back(std::move(texels));
  directions_.push_back(direction);
  counts_.push_back(1.0f);
  if (texels_.size() > most_) merge_nearest();
}

/// Of all pairs the one by which the directions' squared distances from their means grow least
/// (Ward 1963), so that none swallows all the others.
void MergingViews::merge_nearest() {
  std::size_t first = 0, second = 1;
  float least = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < directions_.size(); ++i) {
    for (std::size_t j = i + 1; j < directions_.size(); ++j) {
      const float growth = counts_[i] * counts_[j] / (counts_[i] + counts_[j]) *
                           (directions_[i] - directions_[j]).squaredNorm();
      if (growth < least) {
        least = growth;
        first = i;
        second = j;
      }
    }
  }
  const float count = counts_[first] + counts_[second];
  const float share = counts_[second] / count;
  texels_[first] = merged(texels_[first], texels_[second], share);
  const Eigen::Vector3f between = (1.0f - share) * directions_[first] + share * directions_[second];
  // Opposite ones have nothing between them.
  if (between.norm() > 1e-3f) directions_[first] = between.normalized();
  counts_[first] = count;
  const auto gone = static_cast<std::ptrdiff_t>(second);
  texels_.erase(texels_.begin() + gone);
  directions_.erase(directions_.begin() + gone);
  counts_.erase(counts_.begin() + gone);
}

}  // namespace sheen::fitting::eigen_texture
