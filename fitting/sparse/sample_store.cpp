// SPDX-License-Identifier: MIT
#include "fitting/sparse/sample_store.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace sheen::fitting::sparse {
namespace {

constexpr float kScale = 32767.0f;
constexpr float kDarkest = -0.5f;
constexpr float kBrightest = 1.5f;

std::int16_t coordinate_code(float value) {
  return static_cast<std::int16_t>(std::lround(std::clamp(value, -1.0f, 1.0f) * kScale));
}

std::uint16_t colour_code(float value) {
  return static_cast<std::uint16_t>(
      std::lround((std::clamp(value, kDarkest, kBrightest) - kDarkest) * kScale));
}

float coordinate(std::int16_t code) {
  return static_cast<float>(code) / kScale;
}

float colour(std::uint16_t code) {
  return static_cast<float>(code) / kScale + kDarkest;
}

}  // namespace

DirectedColour SampleStore::Stored::decoded() const {
  return {{coordinate(u), coordinate(v)}, {colour(r), colour(g), colour(b)}};
}

SampleStore::Stored SampleStore::Stored::encoded(const DirectedColour& sample,
                                                 std::uint16_t count) {
  return {coordinate_code(sample.uv.x()), coordinate_code(sample.uv.y()),
          colour_code(sample.rgb.x()),    colour_code(sample.rgb.y()),
          colour_code(sample.rgb.z()),    count};
}

float SampleStore::Stored::squared_distance(const Stored& other) const {
  const float du = static_cast<float>(u) - static_cast<float>(other.u);
  const float dv = static_cast<float>(v) - static_cast<float>(other.v);
  return du * du + dv * dv;
}

// The mean of all samples that went into both, up to the saturation of the counts: a camera held
// still keeps forgetting slowly instead of freezing.
SampleStore::Stored SampleStore::merged(const Stored& a, const Stored& b) {
  constexpr int largest_count = 255;
  const DirectedColour first = a.decoded();
  const DirectedColour second = b.decoded();
  const float share = static_cast<float>(b.count) / static_cast<float>(a.count + b.count);
  return Stored::encoded(
      {first.uv + share * (second.uv - first.uv), first.rgb + share * (second.rgb - first.rgb)},
      static_cast<std::uint16_t>(std::min(largest_count, a.count + b.count)));
}

SampleStore::Pair SampleStore::nearest_to(const Stored& sample) const {
  Pair nearest;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const float distance = sample.squared_distance(samples_[i]);
    if (distance < nearest.squared_distance) {
      nearest = {static_cast<std::uint16_t>(i), 0, distance};
    }
  }
  return nearest;
}

void SampleStore::find_closest() {
  closest_ = {};
  for (std::size_t i = 1; i < samples_.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const float distance = samples_[i].squared_distance(samples_[j]);
      if (distance < closest_.squared_distance) {
        closest_ = {static_cast<std::uint16_t>(j), static_cast<std::uint16_t>(i), distance};
      }
    }
  }
}

void SampleStore::update_closest(std::uint16_t moved) {
  if (moved == closest_.first || moved == closest_.second) {
    find_closest();
    return;
  }
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const float distance = samples_[moved].squared_distance(samples_[i]);
    if (i != moved && distance < closest_.squared_distance) {
      closest_ = {moved, static_cast<std::uint16_t>(i), distance};
    }
  }
}

// In quarters: doubling would waste a third of the memory of patches with few samples.
void SampleStore::grow(std::size_t max_samples) {
  const std::size_t wanted = samples_.size() + std::max<std::size_t>(4, samples_.size() / 4);
  samples_.reserve(std::min(wanted, max_samples));
}

void SampleStore::add(const Sample& sample, std::size_t max_samples) {
  assert(max_samples >= 2 && max_samples <= kMaxStoredSamples);
  const Stored added =
      Stored::encoded({{static_cast<float>(sample.u), static_cast<float>(sample.v)},
                       {static_cast<float>(sample.rgb[0]), static_cast<float>(sample.rgb[1]),
                        static_cast<float>(sample.rgb[2])}},
                      1);
  if (samples_.size() < max_samples) {
    if (samples_.size() == samples_.capacity()) grow(max_samples);
    samples_.push_back(added);
    if (samples_.size() == max_samples) find_closest();
    return;
  }
  // Full: merge the closest pair among the kept and the new one.
  const Pair nearest = nearest_to(added);
  if (nearest.squared_distance <= closest_.squared_distance) {
    samples_[nearest.first] = merged(samples_[nearest.first], added);
    update_closest(nearest.first);
  } else {
    samples_[closest_.first] = merged(samples_[closest_.first], samples_[closest_.second]);
    samples_[closest_.second] = added;
    find_closest();
  }
}

}  // namespace sheen::fitting::sparse
