// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "core/samples/vertex_view.h"
#include "core/visibility/ray_caster.h"
#include "fitting/guidance/view_utility.h"

#include <Eigen/Core>

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace sheen::fitting::guidance {

/// Where a camera could stand: places spread evenly over the part of a sphere round the object
/// that lies above the board. Object frame, metres.
std::vector<Eigen::Vector3f> candidate_places(const Eigen::Vector3f& centre, float distance_m,
                                              const Eigen::Vector3f& up, int count);

/// What a camera would see from places round an object, and which of them would teach most.
class CandidateViews {
 public:
  /// Looks at the mesh from every place: a ray per patch and place, so long work for large meshes;
  /// `stop` is asked between places. The mesh need not outlive it.
  CandidateViews(const core::Mesh& mesh, const core::RayCaster& caster,
                 const core::SamplingLimits& limits, std::vector<Eigen::Vector3f> places,
                 const std::function<bool()>& stop);

  /// Per patch the directions from which some place sees it.
  [[nodiscard]] const std::vector<DirectionCells>& reachable() const { return reachable_; }
  [[nodiscard]] const std::vector<Eigen::Vector3f>& places() const { return places_; }

  /// Variance that a view from every place would take away, weighed by the patches' areas: the sum
  /// over the patches seen of area x (missing before - missing after). Same order as `places`.
  /// `unseen_direction_error` and `area` have an entry per patch.
  [[nodiscard]] std::vector<double> gains(const std::vector<PatchKnowledge>& patches,
                                          const std::vector<float>& unseen_direction_error,
                                          const std::vector<float>& area) const;

 private:
  static constexpr std::uint8_t kUnseen = 255;

  std::vector<Eigen::Vector3f> places_;
  std::vector<std::vector<std::uint8_t>> cell_;  ///< [place][patch]
  std::vector<DirectionCells> reachable_;
};

/// The place to go to from `eye`: most gain per way, a way being the angle about `centre` plus a
/// fifth of a radian. Nothing when nowhere is anything to gain.
std::optional<std::size_t> next_best_view(const std::vector<Eigen::Vector3f>& places,
                                          const std::vector<double>& gains,
                                          const Eigen::Vector3f& centre,
                                          const Eigen::Vector3f& eye);

}  // namespace sheen::fitting::guidance
