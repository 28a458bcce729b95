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
constexpr double kSettled = 0.02;  ///< of a texel: smaller steps are not gone on with
constexpr std::size_t kMostTexels = std::size_t{1} << 21;
constexpr double kOutline_px = 0.5;
constexpr double kSlope = 0.1;        ///< of details
constexpr double kStiffSlope = 0.03;  ///< of a shape that is wrong as a whole

class Refinement {
 public:
  Refinement(const core::Mesh& mesh, std::span<const PosedImage> views,
             std::span<const PosedImage> check_views, float texel_m, Outlines outlines, int threads,
             const std::function<void(int, int)>& progress)
      : mesh_(mesh),
        views_(views),
        check_views_(check_views),
        texel_m_(texel_m),
        outlines_(outlines),
        threads_(threads),
        progress_(progress),
        atlas_(core::make_atlas(mesh, texel_m, kMostTexels)),
        surface_(atlas_),
        field_(mesh),
        edges_(neighbourhood_edges(field_, static_cast<double>(texel_m))) {}

  HeightRefinement run();
  double residual_as_given();

 private:
  struct Attempt {
    Eigen::VectorXd heights;
    double residual;

    [[nodiscard]] bool is_below(const Attempt& other, double fall) const {
      return residual <= (1 - fall) * other.residual;
    }
  };

  void look(SeenTexels& seen, Eigen::VectorXd* outline = nullptr);
  void note_outline(const SeenTexels& seen, const PosedImage& view, Eigen::VectorXd& outline) const;
  double residual(SeenTexels& seen);
  [[nodiscard]] HeightSystem system(const core::Mesh& raised, const SeenTexels& seen) const;
  Attempt attempt(const HeightPrior& prior);
  HeightRefinement outcome(double before, const Attempt& best, const Attempt& kept,
                           std::span<const std::uint8_t> is_seen);
  void tell_progress();

  const core::Mesh& mesh_;
  std::span<const PosedImage> views_, check_views_;
  float texel_m_;
  Outlines outlines_;
  int threads_;
  const std::function<void(int, int)>& progress_;
  core::Atlas atlas_;
  detail::SurfaceTexels surface_;
  HeightField field_;
  int edges_;  ///< that a neighbourhood reaches over
  std::vector<TexelStatistics> texels_;
  int looked_at_ = 0;
};

void Refinement::tell_progress() {
  // Of the mesh as it is and of one or two attempts; where there is a third, it is not foreseen.
  const std::size_t attempts = outlines_ == Outlines::stay ? 1 : 2;
  const auto all = static_cast<int>((1 + attempts * kPasses) * views_.size() +
                                    (1 + attempts) * check_views_.size());
  looked_at_ = std::min(looked_at_ + 1, all);
  if (progress_) progress_(looked_at_, all);
}

// A texel belongs to one triangle and a triangle to one thread; views come in order.
void Refinement::look(SeenTexels& seen, Eigen::VectorXd* outline) {
  texels_.assign(atlas_.texel_count(), {});
  for (const PosedImage& view : views_) {
    tell_progress();
    seen.set_view(view);
    seen.for_each(
        [&](std::size_t, const SeenTexel& texel) { texels_[texel.texel_idx].add(texel); });
    if (outline != nullptr) note_outline(seen, view, *outline);
  }
}

/// A height h of a vertex on the outline moves it there by h sin f / z pixels.
void Refinement::note_outline(const SeenTexels& seen, const PosedImage& view,
                              Eigen::VectorXd& outline) const {
  const double focal_px = view.camera->intrinsics().focal_px.mean();
  const Eigen::Vector3f eye = core::eye_in_object(view.camera_from_object);
  for (std::size_t i = 0; i < mesh_.positions.size(); ++i) {
    if (!seen.is_at_outline(i)) continue;
    const auto height = field_.of_vertex(i);
    const Eigen::Vector3f ray = (eye - mesh_.positions[i]).normalized();
    const double cosine = static_cast<double>(field_.directions()[height].dot(ray));
    const double px_per_m = focal_px / static_cast<double>(seen.vertices().depth_m[i]);
    outline[height] += (1 - cosine * cosine) * std::pow(px_per_m / kOutline_px, 2);
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

HeightSystem Refinement::system(const core::Mesh& raised, const SeenTexels& seen) const {
  return {field_, raised, seen.planes(), surface_, atlas_, texels_, edges_, threads_};
}

/// Moves heights on from those that the first step led to, and measures what is left there.
Refinement::Attempt Refinement::attempt(const HeightPrior& prior) {
  const double settled_m = kSettled * static_cast<double>(texel_m_);
  bool has_settled = false;
  for (int pass = 1; pass < kPasses && !has_settled; ++pass) {
    const core::Mesh raised = field_.raised();
    SeenTexels seen(raised, atlas_, surface_, threads_);
    look(seen);
    const Eigen::VectorXd step = system(raised, seen).step(prior, static_cast<double>(texel_m_));
    field_.heights() += step;
    has_settled = step.squaredNorm() < settled_m * settled_m * static_cast<double>(step.size());
  }
  const core::Mesh raised = field_.raised();
  SeenTexels seen(raised, atlas_, surface_, threads_);
  look(seen);
  return {field_.heights(), residual(seen)};
}

double Refinement::residual_as_given() {
  SeenTexels seen(mesh_, atlas_, surface_, threads_);
  look(seen);
  return residual(seen);
}

// A mesh of which only details are wrong has right outlines. They are let go where that is clearly
// better, first for the shape as a whole and only then for its details: what gloss and errors of
// poses pass for are details.
HeightRefinement Refinement::run() {
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(field_.size()));
  HeightPrior keeps_outlines{kSlope, none};
  SeenTexels seen(mesh_, atlas_, surface_, threads_);
  look(seen, &keeps_outlines.outline);
  const Attempt given{none, residual(seen)};
  const HeightSystem first = system(mesh_, seen);
  const auto attempt_from_given = [&](const HeightPrior& prior) {
    field_.heights() = none;
    field_.heights() = first.step(prior, static_cast<double>(texel_m_));
    return attempt(prior);
  };

  const Attempt kept = attempt_from_given(keeps_outlines);
  Attempt best = kept.is_below(given, kLeastFall) ? kept : given;
  if (outlines_ == Outlines::may_move) {
    const Attempt whole = attempt_from_given({kStiffSlope, none});
    if (whole.is_below(best, kClearFall)) {
      field_.heights() = whole.heights;
      const Attempt details = attempt({kSlope, none});
      best = details.is_below(whole, kLeastFall) ? details : whole;
    }
  }
  return outcome(given.residual, best, kept, first.seen());
}

/// Where nothing is accepted, `kept` is told of.
HeightRefinement Refinement::outcome(double before, const Attempt& best, const Attempt& kept,
                                     std::span<const std::uint8_t> is_seen) {
  HeightRefinement result{.mesh = mesh_, .residual_before = before};
  result.is_accepted = best.residual < before;
  const Attempt& told = result.is_accepted ? best : kept;
  result.residual_after = told.residual;
  std::vector<double> magnitudes;
  for (std::size_t i = 0; i < is_seen.size(); ++i) {
    if (is_seen[i] != 0) {
      magnitudes.push_back(std::abs(told.heights[static_cast<Eigen::Index>(i)]));
    }
  }
  if (!magnitudes.empty()) result.median_m = core::upper_median(magnitudes);
  if (result.is_accepted) {
    field_.heights() = best.heights;
    result.mesh = field_.raised();
  }
  return result;
}

}  // namespace

HeightRefinement refine_heights(const core::Mesh& mesh, std::span<const PosedImage> views,
                                std::span<const PosedImage> check_views, float texel_m,
                                Outlines outlines, int threads,
                                const std::function<void(int, int)>& progress) {
  if (views.size() < 2 || check_views.empty() || mesh.triangles.empty()) return {.mesh = mesh};
  return Refinement(mesh, views, check_views, texel_m, outlines, threads, progress).run();
}

double print_residual(const core::Mesh& mesh, std::span<const PosedImage> views,
                      std::span<const PosedImage> check_views, float texel_m, int threads) {
  if (views.empty() || check_views.empty() || mesh.triangles.empty()) return 0;
  const std::function<void(int, int)> untold;
  return Refinement(mesh, views, check_views, texel_m, Outlines::stay, threads, untold)
      .residual_as_given();
}

}  // namespace sheen::fitting::heights
