// SPDX-License-Identifier: MIT
#include "fitting/eigen_texture/fit_bases.h"

#include "core/concurrency/parallel_for.h"
#include "fitting/eigen_texture/deviation.h"
#include "fitting/eigen_texture/factors.h"
#include "fitting/eigen_texture/stored_channel.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace sheen::fitting::eigen_texture {
namespace {

using Eigen::Index;
using Eigen::MatrixXf;
using Eigen::VectorXf;
using Views = std::span<const std::vector<SeenTexel>>;
using Means = std::span<const Texel>;

/// Texels regressed at once.
constexpr std::size_t kBlock = 1024;

/// The views first, first + stride, ...
struct Every {
  std::size_t first, stride;
};

/// Those of the texels whose slot is a multiple of `step` in some of the views.
std::array<Deviations, 3> sampled_deviations(Views views, const Every& some, Means mean,
                                             std::size_t step) {
  const auto texels = static_cast<Index>((mean.size() + step - 1) / step);
  const auto count = static_cast<Index>((views.size() - some.first - 1) / some.stride + 1);
  std::array<Deviations, 3> channels;
  for (Deviations& channel : channels) {
    channel = {MatrixXf::Zero(texels, count), MatrixXf::Zero(texels, count)};
  }
  for (Index i = 0; i < count; ++i) {
    for (const SeenTexel& seen : views[some.first + static_cast<std::size_t>(i) * some.stride]) {
      if (seen.slot % step != 0) continue;
      const auto row = static_cast<Index>(seen.slot / step);
      const LumaChroma value = deviation(seen.rgb, mean[seen.slot]);
      for (std::size_t channel = 0; channel < 3; ++channel) {
        channels[channel].value(row, i) = value[channel];
        channels[channel].weight(row, i) = seen.squared_cosine();
      }
    }
  }
  return channels;
}

/// From coefficients of every stride-th view to those of all.
void explain_views_between(Views views, std::size_t stride, Means mean, std::size_t step,
                           const std::array<float, 3>& noise, int threads,
                           std::array<Factors, 3>& channels) {
  std::array<MatrixXf, 3> all;
  const auto put = [&](std::size_t c, std::size_t first, const MatrixXf& coefficients) {
    for (Index i = 0; i < coefficients.rows(); ++i) {
      all[c].row(static_cast<Index>(first) + i * static_cast<Index>(stride)) = coefficients.row(i);
    }
  };
  for (std::size_t c = 0; c < 3; ++c) {
    all[c].resize(static_cast<Index>(views.size()), channels[c].rank());
    put(c, 0, channels[c].coefficients);
  }
  for (std::size_t first = 1; first < stride; ++first) {
    const auto deviations = sampled_deviations(views, {first, stride}, mean, step);
    for (std::size_t c = 0; c < 3; ++c) {
      put(c, first, explain_all(channels[c].basis, deviations[c], noise[c], threads));
    }
  }
  for (std::size_t c = 0; c < 3; ++c) channels[c].coefficients = std::move(all[c]);
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

std::array<Channel, 3> fit_bases(Views views, Means mean, std::size_t bases, int sweeps,
                                 int threads) {
  if (views.empty() || mean.empty() || bases == 0) return {};
  // Coefficients from a sample of the texels.
  const std::size_t step = sampling_step(mean.size());
  const std::size_t stride = (views.size() - 1) / kMostFactorised + 1;
  const auto deviations = sampled_deviations(views, {0, stride}, mean, step);
  const auto most = std::min(static_cast<Index>(bases), deviations[0].value.cols());
  std::array<Factors, 3> channels;
  for (std::size_t c = 0; c < 3; ++c) channels[c] = factorise(deviations[c], most, sweeps, threads);
  const auto given = give_out_bases(channels, bases);
  std::array<float, 3> noise{};
  std::array<VectorXf, 3> ridges;
  for (std::size_t c = 0; c < 3; ++c) {
    channels[c].truncate(given[c]);
    noise[c] = deviations[c].noise_of(channels[c]);
    ridges[c] = ridge_of(channels[c], noise[c]);
  }
  if (stride > 1) explain_views_between(views, stride, mean, step, noise, threads, channels);
  for (std::size_t c = 0; c < 3; ++c) {
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
