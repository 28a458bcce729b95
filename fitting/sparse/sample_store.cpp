// SPDX-License-Identifier: MIT
#include "fitting/sparse/sample_store.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace sheen::fitting::sparse {
namespace {

constexpr float kScale = 32767.0f;
constexpr float kDarkest = -0.5f;
constexpr float kBrightest = 1.5f;
// A camera held still keeps forgetting slowly instead of freezing.
constexpr unsigned kLargestCount = 255;
// Spacing at first and how much it grows at a time: small steps give up few samples at once.
constexpr float kFirstSpacing = 0.02f;
constexpr float kSpacingGrowth = 1.1f;
constexpr std::size_t kSpacings = 64;  // the last is wider than the disc

float squared_spacing(std::size_t step) {
  static const auto table = [] {
    std::array<float, kSpacings> squares{};
    float spacing = kFirstSpacing;
    for (float& square : squares) {
      square = spacing * spacing;
      spacing *= kSpacingGrowth;
    }
    return squares;
  }();
  return table[step];
}

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

// Normalised residuals on a logarithmic scale from 1e-4 to about 3.
constexpr float kLeastResidual = 1e-4f;
constexpr float kStepsPerOctave = 17.0f;

}  // namespace

DirectedColour SampleStore::at(std::size_t idx, const SamplePool& pool) const {
  assert(idx < size_);
  const SampleBlock& block = block_of(idx, pool);
  const std::size_t i = idx % SampleBlock::kSamples;
  return {direction(idx, pool), {colour(block.r[i]), colour(block.g[i]), colour(block.b[i])}};
}

Eigen::Vector2f SampleStore::direction(std::size_t idx, const SamplePool& pool) const {
  assert(idx < size_);
  const SampleBlock& block = block_of(idx, pool);
  const std::size_t i = idx % SampleBlock::kSamples;
  return {coordinate(block.u[i]), coordinate(block.v[i])};
}

float SampleStore::count(std::size_t idx, const SamplePool& pool) const {
  assert(idx < size_);
  return static_cast<float>(block_of(idx, pool).count[idx % SampleBlock::kSamples]);
}

std::span<const DirectedColour> SampleStore::read(const SamplePool& pool,
                                                  std::span<DirectedColour> samples) const {
  for (std::size_t idx = 0; idx < size_; ++idx) samples[idx] = at(idx, pool);
  return samples.first(size_);
}

void SampleStore::put(std::size_t idx, const DirectedColour& sample, unsigned count,
                      SamplePool& pool) const {
  SampleBlock& block = block_of(idx, pool);
  const std::size_t i = idx % SampleBlock::kSamples;
  block.u[i] = coordinate_code(sample.uv.x());
  block.v[i] = coordinate_code(sample.uv.y());
  block.r[i] = colour_code(sample.rgb.x());
  block.g[i] = colour_code(sample.rgb.y());
  block.b[i] = colour_code(sample.rgb.z());
  block.count[i] = static_cast<std::uint8_t>(std::min(kLargestCount, count));
}

void SampleStore::move(std::size_t from, std::size_t to, SamplePool& pool) const {
  const SampleBlock& source = block_of(from, pool);
  SampleBlock& target = block_of(to, pool);
  const std::size_t i = from % SampleBlock::kSamples;
  const std::size_t k = to % SampleBlock::kSamples;
  target.u[k] = source.u[i];
  target.v[k] = source.v[i];
  target.r[k] = source.r[i];
  target.g[k] = source.g[i];
  target.b[k] = source.b[i];
  target.count[k] = source.count[i];
  target.normalised_residual[k] = source.normalised_residual[i];
}

void SampleStore::set_normalised_residual(std::size_t idx, float normalised_residual,
                                          SamplePool& pool) const {
  const float octaves = std::log2(std::max(normalised_residual, kLeastResidual) / kLeastResidual);
  block_of(idx, pool).normalised_residual[idx % SampleBlock::kSamples] =
      static_cast<std::uint8_t>(std::min(255.0f, kStepsPerOctave * octaves));
}

float SampleStore::normalised_residual(std::size_t idx, const SamplePool& pool) const {
  static const auto table = [] {
    std::array<float, 256> values{};
    for (std::size_t code = 0; code < values.size(); ++code) {
      values[code] =
          kLeastResidual * std::exp2((static_cast<float>(code) + 0.5f) / kStepsPerOctave);
    }
    return values;
  }();
  return table[block_of(idx, pool).normalised_residual[idx % SampleBlock::kSamples]];
}

std::size_t SampleStore::distances(const Eigen::Vector2f& uv, const SamplePool& pool,
                                   std::span<float> squared) const {
  // Measure whole blocks at a time.
  const float u = uv.x() * kScale;
  const float v = uv.y() * kScale;
  std::size_t nearest = 0;
  float smallest = std::numeric_limits<float>::infinity();
  for (std::size_t first = 0; first < size_; first += SampleBlock::kSamples) {
    const SampleBlock& block = block_of(first, pool);
    static_assert(SampleBlock::kSamples == columns::kPlaceBlock);
    std::array<float, SampleBlock::kSamples> here;
    columns::squared_distances(block.u.data(), block.v.data(), u, v, 1.0f / (kScale * kScale),
                               here.data());
    // Keep the nearest, the first of equals.
    const std::size_t end = std::min(SampleBlock::kSamples, size_ - first);
    for (std::size_t i = 0; i < end; ++i) {
      squared[first + i] = here[i];
      if (here[i] < smallest) {
        smallest = here[i];
        nearest = first + i;
      }
    }
  }
  return nearest;
}

bool SampleStore::is_near(std::size_t idx, const Eigen::Vector2f& uv,
                          const SamplePool& pool) const {
  const SampleBlock& block = block_of(idx, pool);
  const std::size_t i = idx % SampleBlock::kSamples;
  const Eigen::Vector2f kept(coordinate(block.u[i]), coordinate(block.v[i]));
  return (kept - uv).squaredNorm() < squared_spacing(spacing_);
}

// The mean of all samples that went into both, up to the saturation of the counts.
SampleStore::Arrival SampleStore::merge(std::size_t idx, const DirectedColour& sample,
                                        unsigned count, SamplePool& pool) {
  const DirectedColour kept = at(idx, pool);
  const unsigned kept_count = block_of(idx, pool).count[idx % SampleBlock::kSamples];
  const float share = static_cast<float>(count) / static_cast<float>(kept_count + count);
  put(idx, {kept.uv + share * (sample.uv - kept.uv), kept.rgb + share * (sample.rgb - kept.rgb)},
      kept_count + count, pool);
  // A difference from a mean of n has 1 + 1 / n times the variance of one sample.
  const float inflation = 1.0f + 1.0f / static_cast<float>(kept_count);
  return {idx, true, size_of(sample.rgb - kept.rgb) / std::sqrt(inflation)};
}

// Widens the spacing until at least one sample merges.
void SampleStore::make_room(SamplePool& pool) {
  std::array<DirectedColour, kMaxStoredSamples> samples;
  const std::size_t before = size_;
  while (size_ == before && spacing_ + 1u < kSpacings) {
    ++spacing_;
    read(pool, samples);
    const float limit = squared_spacing(spacing_);
    std::size_t kept = 1;
    for (std::size_t idx = 1; idx < before; ++idx) {
      // Find the nearest of those kept so far.
      std::size_t nearest = kept;
      float smallest = limit;
      for (std::size_t other = 0; other < kept; ++other) {
        const float squared = (samples[other].uv - samples[idx].uv).squaredNorm();
        if (squared < smallest) {
          smallest = squared;
          nearest = other;
        }
      }
      if (nearest < kept) {
        const unsigned count = block_of(idx, pool).count[idx % SampleBlock::kSamples];
        merge(nearest, samples[idx], count, pool);
        samples[nearest] = at(nearest, pool);
      } else {
        if (kept != idx) move(idx, kept, pool);
        samples[kept] = samples[idx];
        ++kept;
      }
    }
    size_ = static_cast<std::uint8_t>(kept);
  }
}

SampleStore::Arrival SampleStore::add(const DirectedColour& sample, std::size_t max_samples,
                                      SamplePool& pool) {
  assert(max_samples >= 2 && max_samples <= kMaxStoredSamples);
  // Merge with the sample that the last one went to, else with the nearest.
  if (size_ > 0 && is_near(latest_, sample.uv, pool)) return merge(latest_, sample, 1, pool);
  if (size_ > 0) {
    std::array<float, kMaxStoredSamples> squared;
    std::size_t nearest = distances(sample.uv, pool, squared);
    if (squared[nearest] >= squared_spacing(spacing_) && size_ == max_samples) {
      make_room(pool);
      nearest = distances(sample.uv, pool, squared);
    }
    if (squared[nearest] < squared_spacing(spacing_)) {
      latest_ = static_cast<std::uint8_t>(nearest);
      return merge(nearest, sample, 1, pool);
    }
  }
  // Keep it as it is.
  const std::size_t idx = size_;
  if (idx % SampleBlock::kSamples == 0 && block_[idx / SampleBlock::kSamples] == 0) {
    block_[idx / SampleBlock::kSamples] = pool.take();
  }
  ++size_;
  latest_ = static_cast<std::uint8_t>(idx);
  put(idx, sample, 1, pool);
  return {idx, false, 0.0f};
}

}  // namespace sheen::fitting::sparse
