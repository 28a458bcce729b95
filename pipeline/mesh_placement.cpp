// SPDX-License-Identifier: MIT
#include "pipeline/mesh_placement.h"

#include "core/mesh/bounds.h"
#include "fitting/heights/refine_heights.h"
#include "pipeline/evidence/outline_evidence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace sheen::pipeline {
namespace {

constexpr int kRounds = 2;  // the first finds most of it
// Outlines of right drawn meshes are off by up to .4 % of the radius, of real ones by up to 1.7 %:
// of what is clear the print is asked.
constexpr double kLeast = 0.005, kLeast_px = 0.25, kLeastSigmas = 4;
// Print tells little of a mesh that is too small, whose rim lies on the object in all views.
constexpr double kSureGrowth = 0.007, kSureSigmas = 8;
constexpr double kAgainst = 0.02;  // rise of the print's residual that contradicts it

bool is_clear(const OutlineEvidence& outlines, double size_m, double sigma_m) {
  return size_m > kLeast * outlines.radius_m() && size_m * outlines.px_per_m() > kLeast_px &&
         size_m > kLeastSigmas * sigma_m;
}

OutlineEvidence outlines_of(const core::Mesh& mesh, const std::vector<PosedImage>& images,
                            ProgressSink& sink) {
  OutlineEvidence outlines(mesh, images.size() + 1, 1);
  for (std::size_t i = 0; i < images.size(); ++i) {
    const auto index = static_cast<int>(i);
    sink.progress({"comparing outlines", index, static_cast<int>(images.size())});
    outlines.look_at(index, images[i].image, *images[i].camera, images[i].camera_from_object);
  }
  return outlines;
}

/// An object that moved on the way is in two places, and the middle between them is none.
bool moved_on_the_way(const OutlineEvidence& outlines, double misplaced_m) {
  const auto jump = outlines.jump();
  return jump && jump->shift_m.norm() > misplaced_m &&
         is_clear(outlines, jump->shift_m.norm(), jump->sigma_m);
}

/// Moves the mesh by what is clear of `found`, and on by what has been in the round before; false
/// where nothing is, or where it is no matter of the mesh.
bool move_mesh(const OutlineEvidence& outlines, const OutlineEvidence::Misplacement& found,
               MeshPlacement& placement) {
  if (outlines.is_another_shape(found)) return false;
  const bool shifted = !placement.shift_m.isZero(0), grew = placement.growth != 0;
  const bool shifts = shifted || is_clear(outlines, found.shift_m().norm(), found.shift_sigma_m);
  const bool grows = grew || is_clear(outlines, std::abs(found.growth_m()), found.growth_sigma_m);
  if (!shifts && !grows) return false;
  const Eigen::Vector3d shift_m = shifts ? found.shift_m() : Eigen::Vector3d::Zero();
  const double growth_m = grows ? found.growth_m() : 0;
  if (!shifted && !grew &&
      moved_on_the_way(outlines, std::max(shift_m.norm(), std::abs(growth_m)))) {
    return false;
  }

  const double factor = 1 + growth_m / outlines.radius_m();
  const Eigen::Vector3d middle = core::bounds_of(placement.mesh).center().cast<double>();
  for (Eigen::Vector3f& position : placement.mesh.positions) {
    position = (middle + factor * (position.cast<double>() - middle) + shift_m).cast<float>();
  }
  placement.shift_m += shift_m;
  placement.growth = (1 + placement.growth) * factor - 1;
  return true;
}

double print_residual(const core::Mesh& mesh, const DividedStills& stills, int threads) {
  return fitting::heights::print_residual(mesh, stills.views, stills.check_views,
                                          stills.texel_m(mesh), threads);
}

}  // namespace

std::optional<MeshPlacement> place_mesh(const core::Mesh& mesh,
                                        const std::vector<PosedImage>& images, int threads,
                                        ProgressSink& sink) {
  MeshPlacement placement{.mesh = mesh};
  double growth_sigma = 0;  // of the mesh as given
  for (int round = 0; round < kRounds; ++round) {
    const OutlineEvidence outlines = outlines_of(placement.mesh, images, sink);
    const auto found = outlines.misplacement();
    const bool moves = found && move_mesh(outlines, *found, placement);
    if (round == 0 && !moves) return std::nullopt;
    if (round == 0) growth_sigma = found->growth_sigma_m / outlines.radius_m();
    if (!moves) break;
  }
  const DividedStills stills(images);
  const double before = print_residual(mesh, stills, threads);
  const double after = print_residual(placement.mesh, stills, threads);
  if (!(before > 0)) return std::nullopt;
  placement.residual_change = after / before - 1;
  const bool is_confirmed = placement.residual_change <= -fitting::heights::kClearFall;
  const double growth = std::abs(placement.growth);
  const bool is_sure = growth > kSureGrowth && growth > kSureSigmas * growth_sigma &&
                       placement.residual_change < kAgainst;
  if (!is_confirmed && !is_sure) return std::nullopt;
  return placement;
}

Finding MeshPlacement::finding(std::string_view outcome) const {
  const double radius_m = static_cast<double>(core::bounds_of(mesh).diagonal().norm()) / 2;
  const std::string aside = fmt::format("{:.1f} mm beside", 1000 * shift_m.norm());
  const std::string size =
      fmt::format("{:.1f} % {} than", 100 * std::abs(growth), growth > 0 ? "larger" : "smaller");
  if (std::abs(growth) * radius_m > shift_m.norm()) {
    return {"mesh-size",
            fmt::format("the object is {} its mesh{}, by its outlines in all views: {}; check the "
                        "mesh's scale and the size of the tags",
                        size, shift_m.isZero(0) ? "" : ", " + aside + " it", outcome)};
  }
  return {"mesh-place",
          fmt::format("the object stands {} its mesh{}, by its outlines in all views: "
                      "{}; sheen register finds where it stands",
                      aside, growth == 0 ? "" : ", " + size + " it", outcome)};
}

}  // namespace sheen::pipeline
