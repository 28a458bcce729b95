// SPDX-License-Identifier: MIT
#include "fitting/mean/mean_representation.h"

#include "core/concurrency/parallel_for.h"
#include "fitting/mean/mean_light_field.h"
#include "fitting/samples/change_list.h"
#include "fitting/samples/sample.h"
#include "fitting/unseen/fill_unseen.h"

#include <atomic>
#include <cassert>

namespace sheen::fitting::mean {
namespace {

Eigen::Vector3f as_colour(const Rgb& rgb) {
  return {static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2])};
}

class MeanRepresentation final : public Representation {
 public:
  MeanRepresentation(const core::VertexNeighbours& neighbours, int threads)
      : neighbours_(neighbours),
        threads_(threads),
        totals_(neighbours.vertex_count()),
        model_(neighbours.vertex_count()) {}

  const ModelUpdate& absorb(const core::SampleBatch& batch) override;
  const ModelUpdate& finish() override;
  [[nodiscard]] const LightField& light_field() const override { return model_; }
  [[nodiscard]] FitStatistics statistics() const override { return statistics_; }

 private:
  core::VertexNeighbours neighbours_;
  int threads_;
  std::vector<PatchTotal> totals_;
  MeanLightField model_;
  FitStatistics statistics_;
  ChangeList changes_;
  ModelUpdate update_;
};

const ModelUpdate& MeanRepresentation::absorb(const core::SampleBatch& batch) {
  changes_.reset(batch.size());
  std::atomic<std::size_t> used{0};
  core::parallel_for(batch.size(), threads_, [&](std::size_t begin, std::size_t end) {
    std::size_t used_here = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const auto sample = usable_sample(batch, i);
      if (!sample) continue;
      ++used_here;
      PatchTotal& total = totals_[batch.patch[i]];
      total.add(sample->rgb);
      changes_.mark(i, model_.store(batch.patch[i], as_colour(total.mean()), true));
    }
    used += used_here;
  });
  // A mean is the solution of a one-term system.
  statistics_.samples += used;
  statistics_.fits += used;
  statistics_.patch_views += used;
  changes_.list([&](std::size_t i) { return batch.patch[i]; }, update_);
  return update_;
}

const ModelUpdate& MeanRepresentation::finish() {
  std::vector<Eigen::Vector3f> colours(model_.patch_count());
  for (std::size_t patch = 0; patch < colours.size(); ++patch) {
    colours[patch] = model_.mean_colour(patch);
  }
  fill_unseen(neighbours_, model_.observed(), colours);
  changes_.reset(colours.size());
  for (std::size_t patch = 0; patch < colours.size(); ++patch) {
    if (model_.observed()[patch] != 0) continue;
    changes_.mark(patch, model_.store(patch, colours[patch], false));
  }
  changes_.list([](std::size_t patch) { return static_cast<std::uint32_t>(patch); }, update_);
  return update_;
}

}  // namespace

std::unique_ptr<Representation> make_mean_representation(const core::VertexNeighbours& neighbours,
                                                         int threads) {
  assert(threads >= 1);
  return std::make_unique<MeanRepresentation>(neighbours, threads);
}

}  // namespace sheen::fitting::mean
