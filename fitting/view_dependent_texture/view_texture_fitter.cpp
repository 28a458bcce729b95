// SPDX-License-Identifier: MIT
#include "fitting/view_dependent_texture/view_texture_fitter.h"

#include "core/visibility/depth_image.h"
#include "fitting/kept_views/mean_keeper.h"
#include "fitting/view_dependent_texture/view_texture.h"

namespace sheen::fitting::view_dependent_texture {
namespace {

class ViewTextureFitter final : public Fitter {
 public:
  ViewTextureFitter(const core::Mesh& mesh, const Options& options, int threads)
      : depth_(mesh, threads), means_(mesh, threads), model_(options, mesh.positions.size()) {}

  const ModelUpdate& integrate(const core::Observation& observation) override {
    update_.elements.clear();
    means_.integrate(observation);
    model_.set_means(means_.means());
    depth_.draw(observation.view, observation.image.size(), observation.camera_from_object);
    if (depth_.box().empty()) return update_;
    update_.elements = {static_cast<std::uint32_t>(model_.element_count())};
    model_.add(
        keep_view(observation, depth_, model_.options().views.quality, Surroundings::photographed));
    return update_;
  }

  const ModelUpdate& finish() override {
    update_.elements.clear();
    means_.finish();
    model_.set_means(means_.means());
    return update_;
  }

  [[nodiscard]] const LightField& light_field() const override { return model_; }
  [[nodiscard]] FitStatistics statistics() const override { return means_.statistics(); }

 private:
  core::DepthImage depth_;
  MeanKeeper means_;
  ViewTexture model_;
  ModelUpdate update_;
};

}  // namespace

std::unique_ptr<Fitter> make_view_texture_fitter(const core::Mesh& mesh, const Options& options,
                                                 int threads) {
  options.check();
  return std::make_unique<ViewTextureFitter>(mesh, options, threads);
}

}  // namespace sheen::fitting::view_dependent_texture
