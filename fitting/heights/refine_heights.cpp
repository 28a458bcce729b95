// SPDX-License-Identifier: MIT
#include "fitting/heights/refine_heights.h"

#include "core/numerics/median.h"
#include "fitting/heights/height_field.h"
#include "fitting/heights/height_system.h"
#include "fitting/heights/local_sums.h"
#include "fitting/heights/texel_statistics.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sheen::fitting::heights {
namespace {

constexpr int kPasses = 5;
constexpr std::size_t kMostTexels = std::size_t{1} << 21;
constexpr double kOutline_px = 0.5;

class Refinement {
 public:
  Refinement(const core::Mesh& mesh, std::span<const PosedImage> views,
             std::span<const PosedImage> check_views, float texel_m, int threads,
             const std::function<void(int, int)>& progress)
      : mesh_(mesh),
        views_(views),
        check_views_(check_views),
        texel_m_(texel_m),
        threads_(threads),
        progress_(progress),
        atlas_(core::make_atlas(mesh, texel_m, kMostTexels)),
        surface_(atlas_),
        field_(mesh),
        edges_(neighbourhood_edges(field_, static_cast<double>(texel_m))),
        outline_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(field_.size()))) {}

  HeightRefinement run();

 private:
  void look(SeenTexels& seen, bool notes_outlines);
  void note_outline(const SeenTexels& seen, const PosedImage& view);
  double residual(SeenTexels& seen);
  void tell_progress();

  const core::Mesh& mesh_;
  std::span<const PosedImage> views_, check_views_;
  float texel_m_;
  int threads_;
  const std::function<void(int, int)>& progress_;
  core::Atlas atlas_;
  detail::SurfaceTexels surface_;
  HeightField field_;
  int edges_;                ///< that a neighbourhood reaches over
  Eigen::VectorXd outline_;  ///< of every height: what keeps outlines, 1 / m^2
  std::vector<TexelStatistics> texels_;
  int looked_at_ = 0;
};

void Refinement::tell_progress() {
  const auto all = (kPasses + 1) * views_.size() + 2 * check_views_.size();
  if (progress_) progress_(++looked_at_, static_cast<int>(all));
}

// A texel belongs to one triangle and a triangle to one thread; views come in order.
void Refinement::look(SeenTexels& seen, bool notes_outlines) {
  texels_.assign(atlas_.texel_count(), {});
  for (const PosedImage& view : views_) {
    tell_progress();
    seen.set_view(view);
    seen.for_each(
        [&](std::size_t, const SeenTexel& texel) { texels_[texel.texel_idx].add(texel); });
    if (notes_outlines) note_outline(seen, view);
  }
}

/// A height h of a vertex on the outline moves it there by h sin f / z pixels.
void Refinement::note_outline(const SeenTexels& seen, const PosedImage& view) {
  const double focal_px = view.camera->intrinsics().focal_px.mean();
  const Eigen::Vector3f eye = core::eye_in_object(view.camera_from_object);
  for (std::size_t i = 0; i < mesh_.positions.size(); ++i) {
    if (!seen.is_at_outline(i)) continue;
    const auto height = field_.of_vertex(i);
    const Eigen::Vector3f ray = (eye - mesh_.positions[i]).normalized();
    const double cosine = field_.directions()[height].dot(ray);
    const double px_per_m = focal_px / static_cast<double>(seen.vertices().depth_m[i]);
    outline_[height] += (1 - cosine * cosine) * std::pow(px_per_m / kOutline_px, 2);
  }
}

/// Of the check views to the mean picture, less what changes over a whole neighbourhood of a view:
/// that is gloss, and no matter of heights.
double Refinement::residual(SeenTexels& seen) {
  using Sums = Eigen::Matrix<double, 5, 1>;  // weight, differences (RGB), their squares
  std::vector<Sums> triangles(mesh_.triangles.size());
  double square = 0;
  double weight = 0;
  for (const PosedImage& view : check_views_) {
    tell_progress();
    seen.set_view(view);
    std::ranges::fill(triangles, Sums::Zero());
    seen.for_each([&](std::size_t triangle, const SeenTexel& texel) {
      const TexelStatistics& known = texels_[texel.texel_idx];
      if (!(known.weight > 0.0f)) return;
      const auto q = static_cast<double>(texel.weight);
      Sums& sums = triangles[triangle];
      sums[0] += q;
      for (std::size_t channel = 0; channel < 3; ++channel) {
        const auto off = static_cast<double>(texel.rgb[channel] - 128.0f - known.mean(channel));
        sums[static_cast<Eigen::Index>(1 + channel)] += q * off;
        sums[4] += q * off * off;
      }
    });
    for (const Sums& sums : sums_around(field_, mesh_, triangles, edges_)) {
      if (!(sums[0] > 0)) continue;
      square += std::max(0.0, sums[4] - sums.segment<3>(1).squaredNorm() / sums[0]);
      weight += 3 * sums[0];
    }
  }
  return weight > 0 ? square / weight : 0;
}

HeightRefinement Refinement::run() {
  HeightRefinement result{.mesh = mesh_};
  std::vector<std::uint8_t> is_seen;
  core::Mesh raised = mesh_;
  for (int pass = 0; pass <= kPasses; ++pass) {
    SeenTexels seen(raised, atlas_, surface_, threads_);
    look(seen, pass == 0);
    if (pass == 0) result.residual_before = residual(seen);
    if (pass == kPasses) result.residual_after = residual(seen);
    if (pass == kPasses) break;
    const HeightSystem system(field_, raised, seen.planes(), surface_, atlas_, texels_, edges_,
                              threads_);
    if (pass == 0) is_seen = system.seen();
    field_.heights() += system.step(outline_, texel_m_);
    raised = field_.raised();
  }
  std::vector<double> magnitudes;
  for (std::size_t i = 0; i < is_seen.size(); ++i) {
    if (is_seen[i] != 0) {
      magnitudes.push_back(std::abs(field_.heights()[static_cast<Eigen::Index>(i)]));
    }
  }
  if (!magnitudes.empty()) result.median_m = core::upper_median(magnitudes);
  result.is_accepted =
      result.residual_before > 0 && result.change() <= -kLeastFall && field_.heights().allFinite();
  if (result.is_accepted) result.mesh = std::move(raised);
  return result;
}

}  // namespace

HeightRefinement refine_heights(const core::Mesh& mesh, std::span<const PosedImage> views,
                                std::span<const PosedImage> check_views, float texel_m, int threads,
                                const std::function<void(int, int)>& progress) {
  if (views.size() < 2 || check_views.empty() || mesh.triangles.empty()) return {.mesh = mesh};
  return Refinement(mesh, views, check_views, texel_m, threads, progress).run();
}

}  // namespace sheen::fitting::heights
