// SPDX-License-Identifier: MIT
#include "fitting/sparse/predicted_error.h"

#include "fitting/sparse/stepwise_fit.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <memory>
#include <numeric>

namespace sheen::fitting::sparse {
namespace {

constexpr std::size_t kResidualSamples = 4;
constexpr std::size_t kBlendSamples = 3;

/// Root mean square over channels.
float size_of(const Eigen::Vector3f& difference) {
  return std::sqrt(difference.squaredNorm() / 3.0f);
}

float spread_of(std::span<const DirectedColour> samples) {
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  for (const DirectedColour& sample : samples) mean += sample.rgb;
  mean /= static_cast<float>(samples.size());
  float squared = 0;
  for (const DirectedColour& sample : samples) squared += (sample.rgb - mean).squaredNorm();
  return std::sqrt(squared / (3.0f * static_cast<float>(samples.size())));
}

}  // namespace

float predicted_error(const PatchModel& model, std::span<const DirectedColour> samples,
                      const Eigen::Vector2f& uv) {
  assert(!samples.empty() && samples.size() <= kMaxStoredSamples);
  // Sort the nearest samples to the front.
  std::array<float, kMaxStoredSamples> distance;
  std::array<std::size_t, kMaxStoredSamples> order;
  for (std::size_t i = 0; i < samples.size(); ++i) distance[i] = (samples[i].uv - uv).norm();
  std::iota(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(samples.size()), 0u);
  const std::size_t near = std::min(kResidualSamples, samples.size());
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(near),
                    order.begin() + static_cast<std::ptrdiff_t>(samples.size()),
                    [&](std::size_t a, std::size_t b) {
                      return distance[a] < distance[b] || (distance[a] == distance[b] && a < b);
                    });

  // Leave-one-out residuals of the model's own regression.
  const auto design = std::make_unique<Design>();
  const auto fit = std::make_unique<StepwiseFit>();
  design->load(samples);
  const TermList terms = TermList::of(model);
  design->evaluate(terms);
  fit->build(*design, terms);
  float squared_residual = 0;
  for (std::size_t k = 0; k < near; ++k) {
    const DirectedColour& sample = samples[order[k]];
    const float left = std::max(0.05f, 1.0f - fit->leverage(order[k]));
    const float residual = size_of(sample.rgb - evaluate(model, sample.uv)) / left;
    squared_residual += residual * residual;
  }

  // Blend the nearest views.
  constexpr float softening = 0.01f;
  Eigen::Vector3f blend = Eigen::Vector3f::Zero();
  float total = 0;
  for (std::size_t k = 0; k < std::min(kBlendSamples, near); ++k) {
    const float weight = 1.0f / (distance[order[k]] + softening);
    blend += weight * samples[order[k]].rgb;
    total += weight;
  }
  const Eigen::Vector3f shown = evaluate(model, uv).cwiseMax(0.0f).cwiseMin(1.0f);
  return std::sqrt(squared_residual / static_cast<float>(near)) +
         distance[order[0]] * spread_of(samples) + 0.5f * size_of(shown - blend / total);
}

}  // namespace sheen::fitting::sparse
