// SPDX-License-Identifier: MIT
#include "fitting/nearest_views/nearest_representation.h"

#include "core/concurrency/parallel_for.h"
#include "fitting/nearest_views/light_field_model.h"
#include "fitting/samples/change_list.h"
#include "fitting/samples/sample.h"
#include "fitting/unseen/fill_unseen.h"

#include <atomic>
#include <cassert>

namespace sheen::fitting::nearest_views {
namespace {

class NearestRepresentation final : public Representation {
 public:
  NearestRepresentation(const core::VertexNeighbours& neighbours, int threads)
      : neighbours_(neighbours), threads_(threads), model_(neighbours.vertex_count()) {}

  const ModelUpdate& absorb(const core::SampleBatch& batch) override;
  const ModelUpdate& finish() override;
  [[nodiscard]] const LightField& light_field() const override { return model_; }
  [[nodiscard]] FitStatistics statistics() const override { return statistics_; }

 private:
  core::VertexNeighbours neighbours_;
  int threads_;
  LightFieldModel model_;
  FitStatistics statistics_;
  ChangeList changes_;
  ModelUpdate update_;
};

const ModelUpdate& NearestRepresentation::absorb(const core::SampleBatch& batch) {
  changes_.reset(batch.size());
  std::atomic<std::size_t> used{0};
  core::parallel_for(batch.size(), threads_, [&](std::size_t begin, std::size_t end) {
    std::size_t used_here = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const auto sample = usable_sample(batch, i);
      if (!sample) continue;
      ++used_here;
      model_.add(batch.patch[i], Eigen::Vector2d(sample->u, sample->v).cast<float>(),
                 Eigen::Vector3d(sample->rgb[0], sample->rgb[1], sample->rgb[2]).cast<float>());
      changes_.mark(i, true);
    }
    used += used_here;
  });
  statistics_.samples += used;
  statistics_.patch_views += used;
  changes_.list([&](std::size_t i) { return batch.patch[i]; }, update_);
  return update_;
}

const ModelUpdate& NearestRepresentation::finish() {
  std::vector<Eigen::Vector3f> colours(model_.patch_count());
  for (std::size_t patch = 0; patch < colours.size(); ++patch) {
    colours[patch] = model_.mean_colour(patch);
  }
  fill_unseen(neighbours_, model_.observed(), colours);
  changes_.reset(colours.size());
  for (std::size_t patch = 0; patch < colours.size(); ++patch) {
    if (model_.observed()[patch] != 0) continue;
    changes_.mark(patch, model_.store_unseen(patch, colours[patch]));
  }
  changes_.list([](std::size_t patch) { return static_cast<std::uint32_t>(patch); }, update_);
  return update_;
}

}  // namespace

std::unique_ptr<Representation> make_nearest_representation(
    const core::VertexNeighbours& neighbours, int threads) {
  assert(threads >= 1);
  return std::make_unique<NearestRepresentation>(neighbours, threads);
}

}  // namespace sheen::fitting::nearest_views
