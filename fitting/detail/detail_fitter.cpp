// SPDX-License-Identifier: MIT
#include "fitting/detail/detail_fitter.h"

#include "core/concurrency/parallel_for.h"
#include "core/diagnostics/error.h"
#include "core/mesh/bounds.h"
#include "core/mesh/neighbours.h"
#include "fitting/detail/choose_offsets.h"
#include "fitting/detail/detail_light_field.h"
#include "fitting/detail/fit_anchors.h"
#include "fitting/detail/patch_means.h"
#include "fitting/detail/simplify_texture.h"
#include "fitting/detail/texel_means.h"
#include "fitting/detail/texture_solver.h"
#include "fitting/detail/texture_sums.h"
#include "fitting/detail/triangle_samples.h"
#include "fitting/detail/vertex_means.h"
#include "fitting/sparse/sparse_fitter.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <numeric>
#include <span>
#include <string>

namespace sheen::fitting::detail {
namespace {

constexpr std::size_t kMostTexels = std::size_t{1} << 23;
/// Texels along the diagonal of an object of which it is not known how large it appears.
constexpr float kTexelsAcross = 1000.0f;
/// Triangles of which a choice between vertices and anchors is made at most: with 128 samples each
/// it takes 1 GB.
constexpr std::size_t kMostToChoose = std::size_t{1} << 17;

float texel_m(const core::Mesh& mesh, const Options& options) {
  if (options.texel_mm) return *options.texel_mm * 1e-3f;
  const float diagonal_m = core::bounds_of(mesh).diagonal().norm();
  return diagonal_m > 0.0f ? diagonal_m / kTexelsAcross : 1.0f;
}

core::Atlas atlas_of(const core::Mesh& mesh, const Options& options) {
  core::Atlas atlas = core::make_atlas(mesh, texel_m(mesh, options), kMostTexels);
  if (atlas.texel_count() <= std::size_t{core::kMostAtlasTexels}) return atlas;
  throw core::Error(core::Error::Kind::bad_input, "the object's mesh",
                    "consists of too many separate pieces for a texture",
                    "join its vertices, or use --patches vertex");
}

/// Colours at the vertices, interpolated.
Eigen::Vector3f between(const std::vector<Eigen::Vector3f>& at_vertices,
                        const Eigen::Matrix<std::uint32_t, 3, 1>& triangle,
                        const SurfaceTexel& texel) {
  return (1.0f - texel.at_second - texel.at_third) * at_vertices[triangle[0]] +
         texel.at_second * at_vertices[triangle[1]] + texel.at_third * at_vertices[triangle[2]];
}

/// In one line.
std::string description(const OffsetErrors& errors) {
  if (!(errors.anchors > 0)) return "directions at vertices: nothing to check the choice on";
  std::array<char, 128> line;
  std::snprintf(line.data(), line.size(),
                "directions at %s: on directions left out of the fit vertices err by %.4f, anchors "
                "by %.4f (%+.2f dB)",
                errors.anchors_win() ? "anchors" : "vertices", errors.vertex, errors.anchors,
                errors.difference_db());
  return line.data();
}

class DetailFitter final : public Fitter {
 public:
  DetailFitter(const core::Mesh& mesh, const Options& options, int threads)
      : mesh_(mesh),
        options_(options),
        threads_(threads),
        tolerance_(options.patches.tolerance.value_or(sparse::kToleranceOfUnknownNoise)),
        patches_(
            sparse::make_sparse_fitter(core::vertex_neighbours(mesh), options.patches, threads)),
        model_(mesh, atlas_of(mesh, options)),
        raster_(mesh, threads),
        texel_means_(mesh, model_.texture(), threads),
        texture_sums_(mesh, model_.texture().atlas(), threads),
        vertex_means_(mesh, threads),
        patch_means_(mesh.positions.size()) {
    const bool may_move =
        options.offsets == OffsetPlaces::anchors ||
        (options.offsets == OffsetPlaces::automatic && mesh.triangles.size() <= kMostToChoose);
    if (may_move) {
      triangle_samples_ = std::make_unique<TriangleSamples>(
          mesh, texel_means_.surface(), static_cast<std::size_t>(options.patches.max_samples),
          threads);
    }
  }

  const ModelUpdate& integrate(const core::Observation& observation) override;
  const ModelUpdate& finish() override;
  [[nodiscard]] const LightField& light_field() const override { return model_; }
  [[nodiscard]] FitStatistics statistics() const override {
    FitStatistics statistics = patches_->statistics();
    statistics.choice = choice_;
    return statistics;
  }

 private:
  void store_offsets(std::span<const std::uint32_t> changed);
  void store_offset(std::uint32_t patch);
  void store_all_offsets();
  void back_to_vertices();
  [[nodiscard]] bool choose_anchors();
  [[nodiscard]] float anchor_spacing_m() const;
  void move_to_anchors(Planes& planes);
  [[nodiscard]] Planes starting_texture() const;
  [[nodiscard]] std::vector<float> texel_weights() const;
  [[nodiscard]] float noise() const;
  void store_texture(const Planes& planes);

  const core::Mesh& mesh_;
  Options options_;
  int threads_;
  float tolerance_;
  std::unique_ptr<sparse::SparseFitter> patches_;
  DetailLightField model_;
  ViewRaster raster_;
  TexelMeans texel_means_;
  TextureSums texture_sums_;
  VertexMeans vertex_means_;
  PatchMeans patch_means_;
  std::unique_ptr<TriangleSamples> triangle_samples_;  ///< where there may be anchors
  std::string choice_;
  core::SampleBatch samples_;
  ModelUpdate update_;
};

const ModelUpdate& DetailFitter::integrate(const core::Observation& observation) {
  const bool leaves_anchors = model_.anchors() != nullptr;
  raster_.set_view(observation);
  texel_means_.integrate(observation, raster_, model_.texture());
  texture_sums_.integrate(observation, raster_);
  if (triangle_samples_) triangle_samples_->integrate(observation, raster_, texel_means_.corners());
  samples_ = observation.samples;
  vertex_means_.average(raster_, texel_means_.corners(), samples_);
  patch_means_.integrate(samples_);
  store_offsets(patches_->PatchFitter::integrate(samples_).elements);
  if (leaves_anchors) back_to_vertices();
  for (const std::uint32_t page : texel_means_.touched_pages()) {
    update_.elements.push_back(static_cast<std::uint32_t>(model_.patch_count()) + page);
  }
  return update_;
}

// Those of models that changed, and those whose mean did.
void DetailFitter::store_offsets(std::span<const std::uint32_t> changed) {
  update_.elements.clear();
  std::ranges::set_union(changed, patch_means_.moved(), std::back_inserter(update_.elements));
  core::parallel_for(
      update_.elements.size(), threads_,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) store_offset(update_.elements[i]);
      },
      64);
}

// The texture holds the mean colour: a patch keeps how its model differs from its own mean.
void DetailFitter::store_offset(std::uint32_t patch) {
  sparse::PatchModel offset = patches_->light_field().patch(patch);
  if (offset.term_count() == 1) {
    offset.coefficient[0].setZero();
  } else {
    offset.coefficient[0] -= patches_->mean_over_views(patch);
  }
  patch_means_.set_taken(patch);
  model_.offsets().store(patch, offset);
  model_.offsets().store_observed(patch, patches_->light_field().observed()[patch] != 0);
}

/// After `finish` has left them for anchors; all have changed.
void DetailFitter::back_to_vertices() {
  model_.set_anchors(nullptr);
  store_all_offsets();
  update_.elements.resize(model_.patch_count());
  std::iota(update_.elements.begin(), update_.elements.end(), 0u);
}

void DetailFitter::store_all_offsets() {
  for (std::uint32_t patch = 0; patch < model_.patch_count(); ++patch) store_offset(patch);
}

/// Whether offsets go to anchors.
bool DetailFitter::choose_anchors() {
  if (options_.offsets != OffsetPlaces::automatic) return triangle_samples_ != nullptr;
  if (!triangle_samples_) {
    choice_ = "directions at vertices: too many triangles for the choice";
    return false;
  }
  const OffsetErrors errors = check_offsets(mesh_, *patches_, *triangle_samples_,
                                            anchor_spacing_m(), options_.patches, threads_);
  choice_ = description(errors);
  return errors.anchors_win();
}

float DetailFitter::anchor_spacing_m() const {
  return static_cast<float>(options_.anchor_px) * texel_m(mesh_, options_);
}

/// Offsets at anchors in place of those at vertices, and their means out of the texture.
void DetailFitter::move_to_anchors(Planes& planes) {
  const FittedAnchors fitted = fit_anchors(mesh_, *patches_, *triangle_samples_, anchor_spacing_m(),
                                           options_.patches, threads_);
  model_.offsets() = no_offsets(model_.observed());
  model_.set_anchors(fitted.offsets);
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
    for (const SurfaceTexel& texel : texel_means_.surface().of(t)) {
      const Eigen::Vector3f mean = between(fitted.mean, mesh_.triangles[t], texel);
      for (std::size_t channel = 0; channel < 3; ++channel) {
        planes[channel][texel.texel_idx] -= 255.0f * mean[static_cast<Eigen::Index>(channel)];
      }
    }
  }
}

const ModelUpdate& DetailFitter::finish() {
  patches_->finish();
  store_all_offsets();
  Planes planes = starting_texture();
  solve_texture(texture_sums_.texels(), static_cast<std::size_t>(model_.texture().atlas().width),
                mesh_, texel_means_.surface(), threads_, planes);
  if (choose_anchors()) move_to_anchors(planes);
  model_.texture().set_texel_count(
      simplify_texture(model_.texture().atlas(), texel_weights(), noise(), threads_, planes));
  store_texture(planes);
  update_.elements.resize(model_.element_count());
  std::iota(update_.elements.begin(), update_.elements.end(), 0u);
  return update_;
}

/// Means: of what was seen at a texel, or only around it; where nothing was, what the patches say.
Planes DetailFitter::starting_texture() const {
  Planes planes = mean_texture(texture_sums_.texels());
  std::vector<Eigen::Vector3f> at_vertices(model_.patch_count());
  for (std::size_t patch = 0; patch < at_vertices.size(); ++patch) {
    at_vertices[patch] = 255.0f * patches_->light_field().mean_colour(patch);
  }
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
    const WeightedMean* next = texel_means_.of(t).data();
    for (const SurfaceTexel& texel : texel_means_.surface().of(t)) {
      const WeightedMean& mean = *next++;
      const bool seen_around = texture_sums_.texels()[texel.texel_idx].weight > 0;
      if (mean.weight == 0 && seen_around) continue;
      const Eigen::Vector3f around = between(at_vertices, mesh_.triangles[t], texel);
      for (std::size_t channel = 0; channel < 3; ++channel) {
        planes[channel][texel.texel_idx] =
            mean.weight > 0 ? mean.mean(channel) : around[static_cast<Eigen::Index>(channel)];
      }
    }
  }
  return planes;
}

/// As simplify_texture wants them.
std::vector<float> DetailFitter::texel_weights() const {
  std::vector<float> weights(model_.texture().texels().size(), -1.0f);
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
    const WeightedMean* mean = texel_means_.of(t).data();
    for (const SurfaceTexel& texel : texel_means_.surface().of(t)) {
      weights[texel.texel_idx] = mean++->observations();
    }
  }
  return weights;
}

/// Deviation of one observation, of 255: a tolerance is twice it. What the patches estimate would
/// depend on the order of the views.
float DetailFitter::noise() const {
  return 255.0f * 0.5f * tolerance_;
}

/// Texels that no reading touches keep their grey.
void DetailFitter::store_texture(const Planes& planes) {
  std::vector<Texel>& texels = model_.texture().texels();
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
    for (const SurfaceTexel& texel : texel_means_.surface().of(t)) {
      for (std::size_t channel = 0; channel < 3; ++channel) {
        texels[texel.texel_idx][channel] = static_cast<std::uint8_t>(
            std::lround(std::clamp(planes[channel][texel.texel_idx], 0.0f, 255.0f)));
      }
    }
  }
}

}  // namespace

std::unique_ptr<Fitter> make_detail_fitter(const core::Mesh& mesh, const Options& options,
                                           int threads) {
  options.check();
  assert(threads >= 1);
  return std::make_unique<DetailFitter>(mesh, options, threads);
}

}  // namespace sheen::fitting::detail
