// SPDX-License-Identifier: MIT
#include "fitting/eigen_texture/batch_fit.h"

#include "core/concurrency/parallel_for.h"
#include "fitting/eigen_texture/deviation.h"
#include "fitting/eigen_texture/factors.h"
#include "fitting/eigen_texture/stored_channel.h"

#include <algorithm>
#include <cstdint>

namespace sheen::fitting::eigen_texture {
namespace {

using Eigen::Index;
using Eigen::MatrixXf;
using Eigen::VectorXf;
using Views = std::span<const std::vector<SeenTexel>>;
using Means = std::span<const Texel>;

/// Texels regressed at once.
constexpr std::size_t kBlock = 1024;

/// Those of the texels whose slot is a multiple of `step`.
std::array<Deviations, 3> sampled_deviations(Views views, Means mean, std::size_t step) {
  const auto texels = static_cast<Index>((mean.size() + step - 1) / step);
  const auto count = static_cast<Index>(views.size());
  std::array<Deviations, 3> channels;
  for (Deviations& channel : channels) {
    channel = {MatrixXf::Zero(texels, count), MatrixXf::Zero(texels, count)};
  }
  for (Index v = 0; v < count; ++v) {
    for (const SeenTexel& seen : views[static_cast<std::size_t>(v)]) {
      if (seen.slot % step != 0) continue;
      const auto row = static_cast<Index>(seen.slot / step);
      const LumaChroma value = deviation(seen.rgb, mean[seen.slot]);
      for (std::size_t channel = 0; channel < 3; ++channel) {
        channels[channel].value(row, v) = value[channel];
        channels[channel].weight(row, v) = seen.squared_cosine();
      }
    }
  }
  return channels;
}

/// What one texel was in all views that saw it.
struct TexelHistory {
  std::vector<std::uint32_t> view;
  std::vector<float> weight;
  std::array<std::vector<float>, 3> value;
};

/// Those of the slots from `begin` to `end`.
std::vector<TexelHistory> histories(Views views, Means mean, std::size_t begin, std::size_t end) {
  std::vector<TexelHistory> texels(end - begin);
  for (std::size_t v = 0; v < views.size(); ++v) {
    auto seen = std::ranges::lower_bound(views[v], begin, {}, &SeenTexel::slot);
    for (; seen != views[v].end() && seen->slot < end; ++seen) {
      TexelHistory& texel = texels[seen->slot - begin];
      texel.view.push_back(static_cast<std::uint32_t>(v));
      texel.weight.push_back(seen->squared_cosine());
      const LumaChroma value = deviation(seen->rgb, mean[seen->slot]);
      for (std::size_t channel = 0; channel < 3; ++channel) {
        texel.value[channel].push_back(value[channel]);
      }
    }
  }
  return texels;
}

void regress_block(const std::vector<TexelHistory>& texels, std::size_t channel,
                   std::size_t first_slot, const VectorXf& ridge, Factors& whole) {
  for (std::size_t i = 0; i < texels.size(); ++i) {
    const TexelHistory& texel = texels[i];
    const auto count = static_cast<Index>(texel.view.size());
    if (count == 0) continue;
    MatrixXf rows(count, whole.rank());
    for (Index v = 0; v < count; ++v) {
      rows.row(v) = whole.coefficients.row(texel.view[static_cast<std::size_t>(v)]);
    }
    whole.basis.row(static_cast<Index>(first_slot + i)) =
        regress(rows, VectorXf::Map(texel.value[channel].data(), count),
                VectorXf::Map(texel.weight.data(), count), ridge);
  }
}

}  // namespace

std::array<Channel, 3> fit_bases(Views views, Means mean, std::size_t bases, int threads) {
  if (views.empty() || mean.empty() || bases == 0) return {};
  // Coefficients from a sample of the texels.
  const std::size_t step = sampling_step(mean.size());
  const auto deviations = sampled_deviations(views, mean, step);
  const auto most = static_cast<Index>(std::min(bases, views.size()));
  std::array<Factors, 3> channels;
  for (std::size_t c = 0; c < 3; ++c) channels[c] = factorise(deviations[c], most, threads);
  const auto given = give_out_bases(channels, bases);
  std::array<VectorXf, 3> ridges;
  for (std::size_t c = 0; c < 3; ++c) {
    channels[c].truncate(given[c]);
    ridges[c] = ridge_of(channels[c], deviations[c].noise_of(channels[c]));
    channels[c].basis.setZero(static_cast<Index>(mean.size()), given[c]);
  }

  // All texels on these coefficients.
  const std::size_t blocks = (mean.size() + kBlock - 1) / kBlock;
  core::parallel_for(
      blocks, threads,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t block = begin; block < end; ++block) {
          const std::size_t first = block * kBlock;
          const auto texels = histories(views, mean, first, std::min(mean.size(), first + kBlock));
          for (std::size_t c = 0; c < 3; ++c) {
            if (given[c] > 0) regress_block(texels, c, first, ridges[c], channels[c]);
          }
        }
      },
      1);
  return {stored(channels[0]), stored(channels[1]), stored(channels[2])};
}

}  // namespace sheen::fitting::eigen_texture
