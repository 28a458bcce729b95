// SPDX-License-Identifier: MIT
#include "fitting/sparse/predicted_error.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace sheen::fitting::sparse {
namespace {

constexpr std::size_t kResidualSamples = 4;
constexpr std::size_t kBlendSamples = 3;

/// The first of a list of squared distances in ascending order; of equals the first.
struct Nearest {
  std::array<std::size_t, kResidualSamples> idx{};
  std::array<float, kResidualSamples> squared{};
  std::size_t count = 0;

  explicit Nearest(std::span<const float> all) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (count == kResidualSamples && all[i] >= squared[count - 1]) continue;
      if (count < kResidualSamples) ++count;
      std::size_t place = count - 1;
      for (; place > 0 && squared[place - 1] > all[i]; --place) {
        squared[place] = squared[place - 1];
        idx[place] = idx[place - 1];
      }
      squared[place] = all[i];
      idx[place] = i;
    }
  }
};

}  // namespace

float colour_spread(std::span<const DirectedColour> samples) {
  assert(!samples.empty());
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  for (const DirectedColour& sample : samples) mean += sample.rgb;
  mean /= static_cast<float>(samples.size());
  float squared = 0;
  for (const DirectedColour& sample : samples) squared += (sample.rgb - mean).squaredNorm();
  return std::sqrt(squared / (3.0f * static_cast<float>(samples.size())));
}

float predicted_error(const SampleStore& samples, const SamplePool& pool, float spread,
                      const Eigen::Vector2f& uv, const Eigen::Vector3f& shown) {
  assert(samples.size() > 0);
  std::array<float, kMaxStoredSamples> squared;
  samples.distances(uv, pool, squared);
  const Nearest near(std::span<const float>(squared.data(), samples.size()));

  // Gather what the nearest samples say.
  constexpr float softening = 0.01f;
  float squared_residual = 0;
  Eigen::Vector3f blend = Eigen::Vector3f::Zero();
  float total = 0;
  for (std::size_t k = 0; k < near.count; ++k) {
    const float normalised_residual = samples.normalised_residual(near.idx[k], pool);
    squared_residual += normalised_residual * normalised_residual;
    if (k >= kBlendSamples) continue;
    const float weight = 1.0f / (std::sqrt(near.squared[k]) + softening);
    blend += weight * samples.at(near.idx[k], pool).rgb;
    total += weight;
  }
  const Eigen::Vector3f displayed = shown.cwiseMax(0.0f).cwiseMin(1.0f);
  return std::sqrt(squared_residual / static_cast<float>(near.count)) +
         std::sqrt(near.squared[0]) * spread + 0.5f * size_of(displayed - blend / total);
}

}  // namespace sheen::fitting::sparse
