// SPDX-License-Identifier: MIT
#include "fitting/detail/detail_fitter.h"

#include "core/concurrency/parallel_for.h"
#include "core/mesh/neighbours.h"
#include "core/numerics/median.h"
#include "fitting/detail/detail_light_field.h"
#include "fitting/detail/texture_solver.h"
#include "fitting/detail/texel_means.h"
#include "fitting/detail/texture_sums.h"
#include "fitting/detail/vertex_means.h"
#include "fitting/sparse/sparse_fitter.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <cstdlib>

namespace sheen::fitting::detail {
namespace {

constexpr std::size_t kMostTexels = std::size_t{1} << 23;

}
std::vector<core::SampleBatch>* g_log = nullptr;
float g_texel_m = 0;
std::function<Eigen::Vector3f(std::uint32_t t, const std::array<float, 3>&, const Eigen::Vector3f& eye)> g_pixel_offset;
namespace {
class DetailFitter final : public Fitter {
 public:
  DetailFitter(const core::Mesh& mesh, const Options& options, int threads)
      : mesh_(mesh),
        options_(options),
        threads_(threads),
        patches_(sparse::make_sparse_fitter(core::vertex_neighbours(mesh), options.patches,
                                            threads)),
        means_(mesh),
        raster_(mesh, threads),
        model_(mesh) {}

  const ModelUpdate& integrate(const core::Observation& observation) override;
  const ModelUpdate& finish() override;
  [[nodiscard]] const DetailLightField& light_field() const override { return model_; }
  [[nodiscard]] FitStatistics statistics() const override { return patches_->statistics(); }

 private:
  void make_texture(const core::Observation& observation);
  void store_offset(std::uint32_t patch);
  void show(const Planes& planes);

  const core::Mesh& mesh_;
  Options options_;
  int threads_;
  std::unique_ptr<sparse::SparseFitter> patches_;
  VertexMeans means_;
  std::optional<core::Atlas> atlas_;
  std::unique_ptr<TextureSums> sums_;
  std::unique_ptr<TexelMeans> live_;
  ViewRaster raster_;
  Planes planes_;
  std::vector<Eigen::Vector3f> at_vertices_;
  std::unique_ptr<sparse::SparseFitter> resid_patches_;
  DetailLightField model_;
  core::SampleBatch samples_;
  ModelUpdate update_;
};

void DetailFitter::make_texture(const core::Observation& observation) {
  std::vector<double> depths_m;
  for (const std::uint32_t patch : observation.samples.patch) {
    depths_m.push_back(static_cast<double>(observation.view.depth_m[patch]));
  }
  float texel_m = 0.001f;
  if (!depths_m.empty()) {
    texel_m = static_cast<float>(core::upper_median(depths_m)) /
              static_cast<float>(observation.camera.intrinsics().focal_px.x());
  }
  if (const char* e = std::getenv("TEXEL")) texel_m *= static_cast<float>(std::atof(e));
  if (options_.texel_mm) texel_m = *options_.texel_mm * 1e-3f;
  g_texel_m = texel_m;
  atlas_ = core::make_atlas(mesh_, texel_m, kMostTexels);
  live_ = std::make_unique<TexelMeans>(mesh_, *atlas_, threads_);
  model_.texture().emplace(*atlas_);
}

const ModelUpdate& DetailFitter::integrate(const core::Observation& observation) {
  if (std::getenv("PASS1")) {
    if (!live_->subtract) { resid_patches_ = sparse::make_sparse_fitter(core::vertex_neighbours(mesh_), options_.patches, threads_); live_->subtract = &planes_; at_vertices_.clear(); for (std::size_t v = 0; v < mesh_.positions.size(); ++v) at_vertices_.push_back(model_.mean_colour(v)); means_.subtract = &at_vertices_; }
    raster_.set_view(observation);
    live_->integrate(observation, raster_);
    samples_ = observation.samples;
    means_.average(live_->triangles(), samples_);
    if (g_log) g_log->push_back(samples_);
    resid_patches_->PatchFitter::integrate(samples_);
    return update_;
  }
  if (std::getenv("PASS2")) {
    static TextureSums* last = nullptr;
    if (!last || last != sums_.get()) { sums_ = std::make_unique<TextureSums>(mesh_, *atlas_, threads_); last = sums_.get(); }
    sums_->offset.assign(mesh_.positions.size(), Eigen::Vector3f::Zero());
    const auto frames = core::tangent_frames(mesh_);
    const Eigen::Vector3f eye = core::eye_in_object(observation.camera_from_object);
    for (size_t i = 0; i < frames.size(); ++i) {
      const auto d = core::direction_towards(frames[i], mesh_.positions[i], eye);
      if (d.cosine <= 0) continue;
      sums_->offset[i] = 255.0f * model_.offsets().colour(i, d.uv);
    }
    raster_.set_view(observation);
    sums_->pixel_offset = g_pixel_offset;
    sums_->eye = eye;
    sums_->integrate(observation, raster_);
    return update_;
  }
  if (!live_) make_texture(observation);
  raster_.set_view(observation);
  live_->integrate(observation, raster_);
  if (std::getenv("PLAINSUM")) {
    if (!sums_) sums_ = std::make_unique<TextureSums>(mesh_, *atlas_, threads_);
    sums_->integrate(observation, raster_);
  }
  samples_ = observation.samples;
  if (!std::getenv("POINT")) means_.average(live_->triangles(), samples_);
  if (g_log) g_log->push_back(samples_);
  update_ = patches_->PatchFitter::integrate(samples_);
  for (const std::uint32_t patch : update_.elements) store_offset(patch);
  return update_;
}

void DetailFitter::store_offset(std::uint32_t patch) {
  sparse::PatchModel model = patches_->light_field().patch(patch);
  if (model.term_count() == 1) {
    model.coefficient[0].setZero();
  } else {
    model.coefficient[0] -= patches_->mean_over_views(patch);
  }
  model_.offsets().store(patch, model);
  model_.offsets().store_observed(patch, patches_->light_field().observed()[patch] != 0);
}

void DetailFitter::show(const Planes& planes) {
  const auto& means = live_->texels();
  auto& texels = model_.texture()->texels();
  for (std::size_t i = 0; i < texels.size(); ++i) {
    if (means[i].weight == 0 && !(sums_ && sums_->texels()[i].weight > 0)) continue;
    for (std::size_t channel = 0; channel < 3; ++channel) {
      texels[i][channel] = static_cast<std::uint8_t>(
          std::clamp(std::lround(planes[channel][i]), 0L, 255L));
    }
  }
}

const ModelUpdate& DetailFitter::finish() {
  if (std::getenv("PASS1")) {
    if (std::getenv("SKIPA")) return update_;
    resid_patches_->finish();
    for (std::uint32_t patch = 0; patch < mesh_.positions.size(); ++patch) {
      sparse::PatchModel m = resid_patches_->light_field().patch(patch);
      if (m.term_count() == 1) m.coefficient[0].setZero(); else m.coefficient[0].array() -= 0.5f;
      model_.offsets().store(patch, m);
      model_.offsets().store_observed(patch, resid_patches_->light_field().observed()[patch] != 0);
    }
    return update_;
  }
  if (!std::getenv("PASS2")) update_ = patches_->finish();
  Planes planes;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    for (const TexelMean& m : live_->texels()) planes[channel].push_back(m.weight == 0 ? 0.0f : static_cast<float>(m.colour[channel]) / (4.0f * static_cast<float>(m.weight)));
  }
  if (sums_ && !std::getenv("NOLSQ")) {
    if (std::getenv("SUMMEAN")) {
      const Planes m = mean_texture(sums_->texels());
      for (size_t c = 0; c < 3; ++c) for (size_t i = 0; i < m[c].size(); ++i) if (sums_->texels()[i].weight > 0) planes[c][i] = m[c][i];
    }
    solve_texture(sums_->texels(), static_cast<std::size_t>(atlas_->width), threads_, planes);
  }
  show(planes);
  if (!std::getenv("PASS2")) planes_ = planes; else return update_;
  update_.elements.resize(mesh_.positions.size());
  std::iota(update_.elements.begin(), update_.elements.end(), 0u);
  for (const std::uint32_t patch : update_.elements) store_offset(patch);
  return update_;
}

}  // namespace

std::unique_ptr<Fitter> make_detail_fitter(const core::Mesh& mesh, const Options& options,
                                           int threads) {
  return std::make_unique<DetailFitter>(mesh, options, threads);
}

}  // namespace sheen::fitting::detail
