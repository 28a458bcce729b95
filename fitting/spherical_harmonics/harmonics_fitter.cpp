// SPDX-License-Identifier: MIT
#include "fitting/spherical_harmonics/harmonics_fitter.h"

#include "fitting/samples/patch_loop.h"
#include "fitting/samples/sample.h"
#include "fitting/spherical_harmonics/basis.h"
#include "fitting/spherical_harmonics/light_field_model.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

namespace sheen::fitting::spherical_harmonics {
namespace {

template <std::size_t kTerms>
using Coefficients = Eigen::Matrix<double, static_cast<int>(kTerms), 3, Eigen::RowMajor>;

/// Sum Y Y^T and sum Y f^T over the samples of a patch: as good as the samples themselves.
template <std::size_t kTerms>
struct NormalEquations {
  std::array<double, kTerms*(kTerms + 1) / 2> A{};  // upper triangle, column by column
  Coefficients<kTerms> g = Coefficients<kTerms>::Zero();

  void add(const Sample& sample) {
    const double z = std::sqrt(std::max(0.0, 1.0 - sample.u * sample.u - sample.v * sample.v));
    const auto Y = basis<kTerms>(sample.u, sample.v, z);
    const Eigen::RowVector3d rgb(sample.rgb[0], sample.rgb[1], sample.rgb[2]);
    std::size_t entry = 0;
    for (std::size_t col = 0; col < kTerms; ++col) {
      for (std::size_t row = 0; row <= col; ++row) A[entry++] += Y[col] * Y[row];
      g.row(static_cast<Eigen::Index>(col)) += Y[col] * rgb;
    }
  }

  // The constant term has at least one sample and all others the ridge: positive definite.
  [[nodiscard]] Coefficients<kTerms> solve(double ridge) const {
    Eigen::Matrix<double, static_cast<int>(kTerms), static_cast<int>(kTerms)> lower;
    std::size_t entry = 0;
    for (Eigen::Index col = 0; col < lower.cols(); ++col) {
      for (Eigen::Index row = 0; row <= col; ++row) lower(col, row) = A[entry++];
      if (col > 0) lower(col, col) += ridge;
    }
    Coefficients<kTerms> theta = g;
    const Eigen::LLT<Eigen::Ref<decltype(lower)>, Eigen::Lower> factors(lower);
    factors.solveInPlace(theta);
    return theta;
  }

  [[nodiscard]] Eigen::Vector3f mean() const {
    return (g.row(0).transpose() * (kY00 / A[0])).template cast<float>();
  }
};

template <std::size_t kTerms>
class HarmonicsFitter final : public PatchFitter {
 public:
  HarmonicsFitter(const core::VertexNeighbours& neighbours, const Options& options, int threads)
      : options_(options),
        loop_(neighbours, threads),
        systems_(neighbours.vertex_count()),
        model_(options.degree, neighbours.vertex_count()) {}

  const ModelUpdate& integrate_samples(const core::SampleBatch& batch) override;
  const ModelUpdate& finish() override;
  [[nodiscard]] const PatchLightField& light_field() const override { return model_; }
  [[nodiscard]] FitStatistics statistics() const override { return loop_.statistics(); }

 private:
  FitOutcome integrate_sample(std::size_t patch_idx, const Sample& sample);

  Options options_;
  PatchLoop loop_;
  // Made with a patch's first sample: 1.5 kB each at degree 3, nothing for what is never seen.
  std::vector<std::unique_ptr<NormalEquations<kTerms>>> systems_;
  LightFieldModel model_;
};

template <std::size_t kTerms>
FitOutcome HarmonicsFitter<kTerms>::integrate_sample(std::size_t patch_idx, const Sample& sample) {
  auto& system = systems_[patch_idx];
  if (!system) system = std::make_unique<NormalEquations<kTerms>>();
  system->add(sample);
  const Coefficients<kTerms> theta = system->solve(options_.ridge);
  bool changed = model_.store_observed(patch_idx, true);
  changed |= model_.store(patch_idx, {theta.data(), static_cast<std::size_t>(theta.size())});
  return {1, changed};
}

template <std::size_t kTerms>
const ModelUpdate& HarmonicsFitter<kTerms>::integrate_samples(const core::SampleBatch& batch) {
  return loop_.integrate(batch, [this](std::size_t patch_idx, const Sample& sample) {
    return integrate_sample(patch_idx, sample);
  });
}

template <std::size_t kTerms>
const ModelUpdate& HarmonicsFitter<kTerms>::finish() {
  // Means of the samples, not of the model, whose far side may be anything.
  const auto mean_of = [this](std::size_t patch_idx) -> Eigen::Vector3f {
    return systems_[patch_idx] ? systems_[patch_idx]->mean() : Eigen::Vector3f::Zero();
  };
  return loop_.finish(model_.observed(), nothing_to_solve, mean_of,
                      [this](std::size_t patch_idx, const Eigen::Vector3f& colour) {
                        return model_.store_constant(patch_idx, colour);
                      });
}

}  // namespace

std::unique_ptr<PatchFitter> make_harmonics_fitter(const core::VertexNeighbours& neighbours,
                                                   const Options& options, int threads) {
  options.check();
  switch (options.degree) {
    case 1:
      return std::make_unique<HarmonicsFitter<4>>(neighbours, options, threads);
    case 2:
      return std::make_unique<HarmonicsFitter<9>>(neighbours, options, threads);
    default:
      return std::make_unique<HarmonicsFitter<16>>(neighbours, options, threads);
  }
}

}  // namespace sheen::fitting::spherical_harmonics
