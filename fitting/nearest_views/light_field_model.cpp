// SPDX-License-Identifier: MIT
#include "fitting/nearest_views/light_field_model.h"

#include "core/geometry/disc_map.h"
#include "fitting/half.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace sheen::fitting::nearest_views {
namespace {

constexpr std::size_t kBlended = 3;

/// A sample and the square of its chord to the direction asked for.
struct Neighbour {
  float chord2 = std::numeric_limits<float>::infinity();
  const StoredSample* sample = nullptr;
};

// The nearest ones, nearest first, and one more that sets the scale.
using Neighbours = std::array<Neighbour, kBlended + 1>;

Eigen::Vector2f direction_of(const StoredSample& sample) {
  return {static_cast<float>(sample[0]), static_cast<float>(sample[1])};
}

Eigen::Vector3f colour_of(const StoredSample& sample) {
  return colour_at(sample.data() + 2);
}

StoredSample stored(const Eigen::Vector2f& uv, const Eigen::Vector3f& colour) {
  assert(uv.allFinite() && colour.allFinite());
  const Eigen::Vector3d rgb = colour.cast<double>();
  return {Eigen::half(uv.x()), Eigen::half(uv.y()), stored_half(rgb.x()), stored_half(rgb.y()),
          stored_half(rgb.z())};
}

void insert(const Neighbour& found, Neighbours& nearest) {
  if (found.chord2 >= nearest.back().chord2) return;
  std::size_t place = nearest.size() - 1;
  for (; place > 0 && found.chord2 < nearest[place - 1].chord2; --place) {
    nearest[place] = nearest[place - 1];
  }
  nearest[place] = found;
}

Neighbours nearest_to(const Eigen::Vector3f& direction, std::span<const StoredSample> samples) {
  Neighbours nearest{};
  for (const StoredSample& sample : samples) {
    const Eigen::Vector3f other = core::hemisphere_from_disc(direction_of(sample));
    insert({(other - direction).squaredNorm(), &sample}, nearest);
  }
  return nearest;
}

float angle_of(float chord2) {
  return 2.0f * std::asin(std::min(1.0f, 0.5f * std::sqrt(chord2)));
}

Eigen::Vector3f blend(const Neighbours& nearest) {
  // On top of a sample it alone counts; when the fourth is as near as the others all count alike.
  constexpr float smallest_angle = 1e-4f;
  constexpr float smallest_rest = 1e-4f;
  const float inverse_scale =
      nearest.back().sample == nullptr
          ? 0.0f
          : 1.0f / std::max(angle_of(nearest.back().chord2), smallest_angle);
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  float weights = 0.0f;
  for (std::size_t i = 0; i < kBlended && nearest[i].sample != nullptr; ++i) {
    const float angle = std::max(angle_of(nearest[i].chord2), smallest_angle);
    const float weight = std::max(1.0f - angle * inverse_scale, smallest_rest) / angle;
    sum += weight * colour_of(*nearest[i].sample);
    weights += weight;
  }
  return sum / weights;
}

}  // namespace

LightFieldModel::LightFieldModel(std::size_t patch_count)
    : samples_(patch_count), observed_(patch_count, 0) {}

LightFieldModel::LightFieldModel(std::vector<std::vector<StoredSample>> samples,
                                 std::vector<std::uint8_t> observed)
    : samples_(std::move(samples)), observed_(std::move(observed)) {
  assert(samples_.size() == observed_.size());
}

WeightedColour LightFieldModel::evaluate(std::size_t patch_idx, const Eigen::Vector2f& uv) const {
  const float weight = observed_[patch_idx] != 0 ? 1.0f : kUnseenWeight;
  if (samples_[patch_idx].empty()) return {Eigen::Vector3f::Constant(0.5f * weight), weight};
  const Eigen::Vector3f direction = core::hemisphere_from_disc(uv);
  return {weight * blend(nearest_to(direction, samples_[patch_idx])), weight};
}

Eigen::Vector3f LightFieldModel::mean_colour(std::size_t patch_idx) const {
  const auto& samples = samples_[patch_idx];
  if (samples.empty()) return Eigen::Vector3f::Constant(0.5f);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const StoredSample& sample : samples) sum += colour_of(sample).cast<double>();
  const Eigen::Vector3f mean = (sum / static_cast<double>(samples.size())).cast<float>();
  return mean.cwiseMax(0.0f).cwiseMin(1.0f);
}

std::size_t LightFieldModel::coefficient_count() const {
  std::size_t count = 0;
  for (const auto& samples : samples_) count += samples.size() * std::tuple_size_v<StoredSample>;
  return count;
}

void LightFieldModel::add(std::size_t patch_idx, const Eigen::Vector2f& uv,
                          const Eigen::Vector3f& colour) {
  if (std::exchange(observed_[patch_idx], std::uint8_t{1}) == 0) samples_[patch_idx].clear();
  samples_[patch_idx].push_back(stored(uv, colour));
}

bool LightFieldModel::store_unseen(std::size_t patch_idx, const Eigen::Vector3f& colour) {
  assert(observed_[patch_idx] == 0);
  // One sample, wherever it lies, is the colour of all directions.
  const StoredSample sample = stored(Eigen::Vector2f::Zero(), colour);
  auto& samples = samples_[patch_idx];
  const auto same = [](Eigen::half a, Eigen::half b) { return a.x == b.x; };
  if (samples.size() == 1 && std::ranges::equal(samples[0], sample, same)) return false;
  samples.assign(1, sample);
  return true;
}

}  // namespace sheen::fitting::nearest_views
