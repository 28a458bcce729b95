// SPDX-License-Identifier: MIT
#include "fitting/detail/patch_means.h"

#include "fitting/samples/sample.h"

#include <algorithm>
#include <optional>

namespace sheen::fitting::detail {
namespace {

constexpr float kVisible = 2.0f / 255.0f;

Four as_bytes(const Rgb& rgb) {
  const auto byte = [](double value) {
    return static_cast<float>(std::clamp(255.0 * value, 0.0, 255.0));
  };
  return Four{1, byte(rgb[0]), byte(rgb[1]), byte(rgb[2])};
}

}  // namespace

void PatchMeans::integrate(const core::SampleBatch& samples) {
  moved_.clear();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::optional<Sample> sample = usable_sample(samples, i);
    if (!sample) continue;
    const double squared_cosine = 1.0 - sample->u * sample->u - sample->v * sample->v;  // eq. 3
    Mean& mean = means_[samples.patch[i]];
    mean.of_views.add(as_bytes(sample->rgb), static_cast<float>(std::max(0.0, squared_cosine)));
    if ((mean.of_views.mean() - mean.taken).cwiseAbs().maxCoeff() > kVisible) {
      moved_.push_back(samples.patch[i]);
    }
  }
}

void PatchMeans::set_taken(std::size_t patch_idx) {
  means_[patch_idx].taken = means_[patch_idx].of_views.mean();
}

}  // namespace sheen::fitting::detail
