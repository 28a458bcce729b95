// SPDX-License-Identifier: MIT
#include "fitting/nearest_views/nearest_fitter.h"

#include "fitting/nearest_views/light_field_model.h"
#include "fitting/samples/patch_loop.h"
#include "fitting/samples/sample.h"

namespace sheen::fitting::nearest_views {
namespace {

class NearestFitter final : public PatchFitter {
 public:
  NearestFitter(const core::VertexNeighbours& neighbours, int threads)
      : loop_(neighbours, threads), model_(neighbours.vertex_count()) {}

  const ModelUpdate& integrate_samples(const core::SampleBatch& batch) override;
  const ModelUpdate& finish() override;
  [[nodiscard]] const PatchLightField& light_field() const override { return model_; }
  [[nodiscard]] FitStatistics statistics() const override { return loop_.statistics(); }

 private:
  PatchLoop loop_;
  LightFieldModel model_;
};

const ModelUpdate& NearestFitter::integrate_samples(const core::SampleBatch& batch) {
  return loop_.integrate(batch, [this](std::size_t patch_idx, const Sample& sample) {
    model_.add(patch_idx, Eigen::Vector2d(sample.u, sample.v).cast<float>(),
               Eigen::Vector3d(sample.rgb.data()).cast<float>());
    return FitOutcome{0, true};
  });
}

const ModelUpdate& NearestFitter::finish() {
  return loop_.finish(
      model_.observed(), nothing_to_solve,
      [this](std::size_t patch_idx) { return model_.mean_colour(patch_idx); },
      [this](std::size_t patch_idx, const Eigen::Vector3f& colour) {
        return model_.store_unseen(patch_idx, colour);
      });
}

}  // namespace

std::unique_ptr<PatchFitter> make_nearest_fitter(const core::VertexNeighbours& neighbours,
                                                 int threads) {
  return std::make_unique<NearestFitter>(neighbours, threads);
}

}  // namespace sheen::fitting::nearest_views
