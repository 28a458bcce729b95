// SPDX-License-Identifier: MIT
#include "fitting/billboard/billboard_fitter.h"

#include "core/samples/vertex_view.h"
#include "fitting/billboard/bake.h"
#include "fitting/billboard/billboards.h"
#include "fitting/descriptor.h"

#include <algorithm>
#include <numeric>

namespace sheen::fitting::billboard {
namespace {

class BillboardFitter final : public Fitter {
 public:
  BillboardFitter(const core::Mesh& mesh, const Options& options, int threads)
      : mesh_(mesh),
        threads_(threads),
        frames_(core::tangent_frames(mesh)),
        source_(make_fitter(options.baked_from, mesh, {}, threads)),
        patches_(require_patches(source_->light_field(), "a billboard's source")),
        baker_(mesh, frames_, patches_, kFrameSamples),
        model_(options, bounding_sphere(mesh), mesh.positions.size()) {}

  [[nodiscard]] bool needs_images() const override { return source_->needs_images(); }
  const ModelUpdate& integrate(const core::Observation& observation) override;
  const ModelUpdate& finish() override;
  [[nodiscard]] const LightField& light_field() const override { return model_; }
  [[nodiscard]] FitStatistics statistics() const override { return source_->statistics(); }

 private:
  const core::Mesh& mesh_;
  int threads_;
  std::vector<core::TangentFrame> frames_;
  std::unique_ptr<Fitter> source_;
  const PatchLightField& patches_;
  FrameBaker baker_;
  Billboards model_;
  ModelUpdate update_;
};

const ModelUpdate& BillboardFitter::integrate(const core::Observation& observation) {
  source_->integrate(observation);
  const Eigen::Vector3f towards =
      core::eye_in_object(observation.camera_from_object) - model_.sphere().centre;
  const auto directions = model_.directions();
  const auto nearest = std::ranges::max_element(
      directions, {}, [&](const Eigen::Vector3f& direction) { return direction.dot(towards); });
  const auto frame_idx = static_cast<std::size_t>(nearest - directions.begin());
  model_.set_frame(frame_idx,
                   encode(baker_.bake(model_.camera(frame_idx)), model_.options().views.quality));
  update_.elements = {static_cast<std::uint32_t>(frame_idx)};
  return update_;
}

const ModelUpdate& BillboardFitter::finish() {
  source_->finish();
  bake_all(mesh_, frames_, patches_, threads_, model_);
  update_.elements.resize(model_.element_count());
  std::iota(update_.elements.begin(), update_.elements.end(), 0u);
  return update_;
}

}  // namespace

std::unique_ptr<Fitter> make_billboard_fitter(const core::Mesh& mesh, const Options& options,
                                              int threads) {
  options.check();
  return std::make_unique<BillboardFitter>(mesh, options, threads);
}

}  // namespace sheen::fitting::billboard
