// SPDX-License-Identifier: MIT
#include "fitting/mean/mean_fitter.h"

#include "fitting/mean/mean_light_field.h"
#include "fitting/samples/patch_loop.h"
#include "fitting/samples/sample.h"

#include <vector>

namespace sheen::fitting::mean {
namespace {

Eigen::Vector3f as_colour(const Rgb& rgb) {
  return {static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2])};
}

class MeanFitter final : public PatchFitter {
 public:
  MeanFitter(const core::VertexNeighbours& neighbours, int threads)
      : loop_(neighbours, threads),
        totals_(neighbours.vertex_count()),
        model_(neighbours.vertex_count()) {}

  const ModelUpdate& integrate_samples(const core::SampleBatch& batch) override;
  const ModelUpdate& finish() override;
  [[nodiscard]] const PatchLightField& light_field() const override { return model_; }
  [[nodiscard]] FitStatistics statistics() const override { return loop_.statistics(); }

 private:
  PatchLoop loop_;
  std::vector<PatchTotal> totals_;
  MeanLightField model_;
};

const ModelUpdate& MeanFitter::integrate_samples(const core::SampleBatch& batch) {
  return loop_.integrate(batch, [this](std::size_t patch_idx, const Sample& sample) {
    PatchTotal& total = totals_[patch_idx];
    total.add(sample.rgb);
    // A mean is the solution of a one-term system.
    return FitOutcome{1, model_.store(patch_idx, as_colour(total.mean()), true)};
  });
}

const ModelUpdate& MeanFitter::finish() {
  return loop_.finish(
      model_.observed(), nothing_to_solve,
      [this](std::size_t patch_idx) { return model_.mean_colour(patch_idx); },
      [this](std::size_t patch_idx, const Eigen::Vector3f& colour) {
        return model_.store(patch_idx, colour, false);
      });
}

}  // namespace

std::unique_ptr<PatchFitter> make_mean_fitter(const core::VertexNeighbours& neighbours,
                                              int threads) {
  return std::make_unique<MeanFitter>(neighbours, threads);
}

}  // namespace sheen::fitting::mean
