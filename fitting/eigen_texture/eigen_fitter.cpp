// SPDX-License-Identifier: MIT
#include "fitting/eigen_texture/eigen_fitter.h"

#include "core/diagnostics/error.h"
#include "fitting/detail/weighted_mean.h"
#include "fitting/eigen_texture/eigen_texture.h"
#include "fitting/eigen_texture/fit_bases.h"
#include "fitting/eigen_texture/texel_reader.h"
#include "fitting/eigen_texture/view_history.h"
#include "fitting/kept_views/mean_keeper.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace sheen::fitting::eigen_texture {
namespace {

/// Of every texel the incremental fit keeps so many observations: 8 bytes each.
constexpr std::size_t kMostPerTexel = 64;
/// While views arrive bases are found anew with so many more views, at least, or a third more.
constexpr std::size_t kViewsAtOnce = 8;
/// Sweeps of expectation maximisation for what is only looked at.
constexpr int kLiveSweeps = 2;
/// Part of an atlas that charts fill, about.
constexpr float kFilled = 0.6f;

core::Atlas atlas_of(const core::Mesh& mesh, const Options& options) {
  const auto most = static_cast<std::size_t>(options.texture_side * options.texture_side);
  float area = 0;
  for (const auto& triangle : mesh.triangles) {
    const Eigen::Vector3f& a = mesh.positions[triangle[0]];
    area += 0.5f * (mesh.positions[triangle[1]] - a).cross(mesh.positions[triangle[2]] - a).norm();
  }
  float texel_m = std::sqrt(area / (kFilled * static_cast<float>(most)));
  if (options.texel_mm) texel_m = std::max(texel_m, *options.texel_mm * 1e-3f);
  core::Atlas atlas = core::make_atlas(mesh, texel_m > 0.0f ? texel_m : 1.0f, most);
  if (atlas.texel_count() <= std::size_t{core::kMostAtlasTexels}) return atlas;
  throw core::Error(core::Error::Kind::bad_input, "the object's mesh",
                    "consists of too many separate pieces for a texture",
                    "join its vertices, or use --representation sparse");
}

class EigenFitter final : public Fitter {
 public:
  EigenFitter(const core::Mesh& mesh, const Options& options, int threads)
      : mesh_(mesh),
        options_(options),
        threads_(threads),
        vertex_means_(mesh, threads),
        model_(mesh, atlas_of(mesh, options)),
        reader_(mesh, model_.mean().atlas(), threads),
        means_(reader_.used().size()),
        history_(reader_.used().size(), options.solve == Solve::incremental
                                            ? std::optional(kMostPerTexel)
                                            : std::nullopt) {}

  const ModelUpdate& integrate(const core::Observation& observation) override {
    vertex_means_.integrate(observation);
    model_.set_vertex_means(vertex_means_.means());
    std::vector<SeenTexel> seen = reader_.read(observation);
    for (const SeenTexel& texel : seen) {
      means_[texel.slot].add(
          detail::Four{1.0f, static_cast<float>(texel.rgb[0]), static_cast<float>(texel.rgb[1]),
                       static_cast<float>(texel.rgb[2])},
          texel.squared_cosine());
      store_mean(texel.slot);
    }
    directions_.push_back(model_.direction_to(core::eye_in_object(observation.camera_from_object)));
    history_.add(std::move(seen));
    if (options_.solve == Solve::incremental && directions_.size() == next_solve_) {
      solve(kLiveSweeps);
      next_solve_ += std::max(kViewsAtOnce, directions_.size() / 3);
    }
    update_.elements = {0};
    return update_;
  }

  const ModelUpdate& finish() override {
    vertex_means_.finish();
    model_.set_vertex_means(vertex_means_.means());
    fill_unseen();
    solve(kSweeps);
    update_.elements = {0};
    return update_;
  }

  [[nodiscard]] const LightField& light_field() const override { return model_; }
  [[nodiscard]] FitStatistics statistics() const override { return vertex_means_.statistics(); }

 private:
  [[nodiscard]] std::vector<Texel> used_means() const {
    std::vector<Texel> means;
    for (const std::uint32_t texel : reader_.used()) means.push_back(model_.mean().texels()[texel]);
    return means;
  }

  /// Bases from the views so far.
  void solve(int sweeps) {
    model_.set_bases(fit_bases(history_.views(), used_means(),
                               static_cast<std::size_t>(options_.bases), sweeps, threads_),
                     directions_);
  }

  void store_mean(std::size_t slot) {
    Texel& texel = model_.mean().texels()[reader_.used()[slot]];
    if (means_[slot].weight == 0) return;
    for (std::size_t c = 0; c < 3; ++c) {
      texel[c] = static_cast<std::uint8_t>(std::min(255.0f, means_[slot].mean(c) + 0.5f));
    }
  }

  /// What no view showed has the colours of the vertices around.
  void fill_unseen() {
    std::vector<std::uint8_t> is_seen(model_.mean().texels().size(), 0);
    for (std::size_t slot = 0; slot < means_.size(); ++slot) {
      is_seen[reader_.used()[slot]] = means_[slot].weight > 0;
    }
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const auto& triangle = mesh_.triangles[t];
      for (const detail::SurfaceTexel& texel : reader_.surface().of(t)) {
        if (is_seen[texel.texel_idx] != 0) continue;
        const auto& means = vertex_means_.means();
        const Eigen::Vector3f rgb =
            255.0f * ((1.0f - texel.at_second - texel.at_third) * means.mean_colour(triangle[0]) +
                      texel.at_second * means.mean_colour(triangle[1]) +
                      texel.at_third * means.mean_colour(triangle[2]));
        for (std::size_t c = 0; c < 3; ++c) {
          model_.mean().texels()[texel.texel_idx][c] = static_cast<std::uint8_t>(
              std::lround(std::clamp(rgb[static_cast<Eigen::Index>(c)], 0.0f, 255.0f)));
        }
      }
    }
  }

  const core::Mesh& mesh_;
  Options options_;
  int threads_;
  MeanKeeper vertex_means_;
  EigenTexture model_;
  TexelReader reader_;
  std::vector<detail::WeightedMean> means_;
  ViewHistory history_;
  std::size_t next_solve_ = kViewsAtOnce;
  std::vector<Eigen::Vector3f> directions_;
  ModelUpdate update_;
};

}  // namespace

std::unique_ptr<Fitter> make_eigen_fitter(const core::Mesh& mesh, const Options& options,
                                          int threads) {
  options.check();
  return std::make_unique<EigenFitter>(mesh, options, threads);
}

}  // namespace sheen::fitting::eigen_texture
