// SPDX-License-Identifier: MIT
#include "fitting/nearest_views/model_codec.h"

#include "fitting/nearest_views/light_field_model.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace sheen::fitting::nearest_views {
namespace {

constexpr std::size_t kNumbers = std::tuple_size_v<StoredSample>;
// A glb file has at most 2^32 bytes; keeps products of sizes far from overflow.
constexpr std::size_t kMostSamples = std::size_t{1} << 32;

struct PackedArrays {
  std::vector<std::uint32_t> counts;
  std::vector<StoredSample> samples;
};

std::vector<std::uint32_t> counts_from(std::span<const std::byte> bytes) {
  std::vector<std::uint32_t> counts(bytes.size() / sizeof(std::uint32_t));
  if (!counts.empty()) std::memcpy(counts.data(), bytes.data(), bytes.size());
  return counts;
}

StoredSample sample_from(std::span<const Eigen::half> numbers) {
  StoredSample sample;
  std::ranges::copy(numbers, sample.begin());
  // Directions on the disc, up to the rounding of a half.
  if (std::hypot(static_cast<float>(sample[0]), static_cast<float>(sample[1])) > 1.001f) {
    throw ModelFault("a sample lies outside the disc of directions");
  }
  return sample;
}

}  // namespace

ModelPart encode_model(const LightField& light_field) {
  const auto& model = dynamic_cast<const LightFieldModel&>(light_field);
  const auto packed = std::make_shared<PackedArrays>();
  for (std::size_t i = 0; i < model.patch_count(); ++i) {
    const auto samples = model.samples(i);
    packed->counts.push_back(static_cast<std::uint32_t>(samples.size()));
    packed->samples.insert(packed->samples.end(), samples.begin(), samples.end());
  }
  ModelPart part;
  part.observed = std::as_bytes(std::span(model.observed()));
  part.arrays["counts"] = std::as_bytes(std::span(packed->counts));
  // glTF knows no empty bufferView.
  if (!packed->samples.empty()) part.arrays["samples"] = std::as_bytes(std::span(packed->samples));
  part.owner = packed;
  return part;
}

std::unique_ptr<const LightField> decode_model(const ModelPart& part, const core::Mesh& mesh) {
  auto observed = required_observed(part, mesh.positions.size());
  const std::vector<std::uint32_t> counts =
      counts_from(required_bytes(part, "counts", observed.size() * sizeof(std::uint32_t)));
  std::size_t total = 0;
  for (const std::uint32_t count : counts) {
    total += count;
    if (total > kMostSamples) throw ModelFault("it has more samples than a file can hold");
  }
  std::vector<Eigen::half> numbers;
  if (total > 0) numbers = required_halves(part, "samples", total * kNumbers);
  std::vector<std::vector<StoredSample>> samples(observed.size());
  std::size_t at = 0;
  for (std::size_t i = 0; i < observed.size(); ++i) {
    if (observed[i] == 0 ? counts[i] > 1 : counts[i] == 0) {
      throw ModelFault("the samples of a patch do not fit its observed flag");
    }
    samples[i].reserve(counts[i]);
    for (std::uint32_t k = 0; k < counts[i]; ++k, at += kNumbers) {
      samples[i].push_back(sample_from(std::span(numbers).subspan(at, kNumbers)));
    }
  }
  return std::make_unique<LightFieldModel>(std::move(samples), std::move(observed));
}

}  // namespace sheen::fitting::nearest_views
