// SPDX-License-Identifier: MIT
#include "fitting/eigen_texture/incremental_fit.h"

#include "core/concurrency/parallel_for.h"
#include "fitting/eigen_texture/deviation.h"
#include "fitting/eigen_texture/stored_channel.h"

#include <algorithm>
#include <utility>

namespace sheen::fitting::eigen_texture {
namespace {

using Eigen::Index;
using Eigen::MatrixXf;
using Eigen::VectorXf;

/// What bases leave unexplained, squared grey levels: views are explained as if it were noise.
constexpr float kUnexplained = 9.0f;

/// Coefficients of a view from a part of its texels.
VectorXf coefficients_of(const std::vector<SeenTexel>& view, std::span<const Texel> mean,
                         std::size_t channel, const MatrixXf& basis) {
  const std::size_t step = sampling_step(mean.size());
  std::vector<const SeenTexel*> sample;
  for (const SeenTexel& seen : view) {
    if (seen.slot % step == 0) sample.push_back(&seen);
  }
  const auto count = static_cast<Index>(sample.size());
  MatrixXf rows(count, basis.cols());
  VectorXf value(count), weight(count);
  for (Index i = 0; i < count; ++i) {
    const SeenTexel& seen = *sample[static_cast<std::size_t>(i)];
    rows.row(i) = basis.row(seen.slot);
    value[i] = deviation(seen.rgb, mean[seen.slot])[channel];
    weight[i] = seen.squared_cosine();
  }
  return explain(rows, value, weight, kUnexplained);
}

}  // namespace

IncrementalFit::IncrementalFit(std::size_t used_texels, std::size_t bases, int threads)
    : bases_(bases), threads_(threads), mean_(used_texels), was_seen_(used_texels, 0) {
  for (Factors& factors : factors_) factors.basis.resize(static_cast<Index>(used_texels), 0);
}

void IncrementalFit::add(std::span<const std::vector<SeenTexel>> views, std::vector<Texel> mean) {
  if (views.empty()) return;
  core::parallel_for(
      factors_.size(), threads_,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t channel = begin; channel < end; ++channel) add_to(channel, views, mean);
      },
      1);
  for (const auto& view : views) {
    for (const SeenTexel& seen : view) was_seen_[seen.slot] = 1;
  }
  mean_ = std::move(mean);
}

// The product grows to [B, -moved, R] [[C, 1, 0], [C', 0, I]]^T: earlier views keep their colours
// around the mean that moved, new ones are explained by B as far as it can and R is the rest.
void IncrementalFit::add_to(std::size_t channel, std::span<const std::vector<SeenTexel>> views,
                            const std::vector<Texel>& mean) {
  Factors& factors = factors_[channel];
  const Index texels = factors.basis.rows(), rank = factors.rank();
  const Index before = factors.coefficients.rows(), added = static_cast<Index>(views.size());
  Factors grown{MatrixXf::Zero(texels, rank + 1 + added),
                MatrixXf::Zero(before + added, rank + 1 + added)};
  grown.basis.leftCols(rank) = factors.basis;
  if (before > 0) grown.coefficients.topLeftCorner(before, rank) = factors.coefficients;
  grown.coefficients.col(rank).head(before).setOnes();
  for (Index i = 0; i < texels; ++i) {
    const auto slot = static_cast<std::size_t>(i);
    if (was_seen_[slot] != 0) grown.basis(i, rank) = -deviation(mean[slot], mean_[slot])[channel];
  }
  for (Index v = 0; v < added; ++v) {
    const std::vector<SeenTexel>& view = views[static_cast<std::size_t>(v)];
    const VectorXf explained = coefficients_of(view, mean, channel, factors.basis);
    for (const SeenTexel& seen : view) {
      const float rest = deviation(seen.rgb, mean[seen.slot])[channel] -
                         factors.basis.row(seen.slot).dot(explained);
      grown.basis(seen.slot, rank + 1 + v) = rest;
    }
    grown.coefficients.row(before + v).head(rank) = explained.transpose();
    grown.coefficients(before + v, rank + 1 + v) = 1.0f;
  }
  const std::size_t most = channel == 0 ? bases_ : bases_ / 2;
  factors = canonical(grown, static_cast<Index>(most));
}

std::array<Channel, 3> IncrementalFit::channels() const {
  const auto given = give_out_bases(factors_, bases_);
  std::array<Channel, 3> channels;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    Factors factors = factors_[c];
    factors.truncate(given[c]);
    channels[c] = stored(factors);
  }
  return channels;
}

}  // namespace sheen::fitting::eigen_texture
