// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace sheen::evaluation {

/// How the directions from which a point is seen are spread.
enum class ViewSet {
  uni,      ///< scattered, uniform over the hemisphere above kMinCosine
  arc,      ///< three handheld arcs: wobbling, dwelling here and there
  one_arc,  ///< one of them: nearly collinear on the disc
  gap,      ///< scattered, but nothing in a sector of 100 degrees of azimuth
  clusters  ///< four bunches of 6 degrees
};
inline constexpr std::array kViewSets{ViewSet::uni, ViewSet::arc, ViewSet::one_arc, ViewSet::gap,
                                      ViewSet::clusters};

std::string_view name_of(ViewSet views);

/// Views flatter than this are not taken: n . v.
inline constexpr float kMinCosine = 0.12f;

/// Azimuth sector of `gap` that is not seen, radians, around an azimuth of 0.
inline constexpr float kGapHalfWidth = 0.8726646f;  // 50 degrees

/// One direction of a view set: unit, patch frame, z > kMinCosine. `key` names it in the point's
/// longest sequence: the same key is the same view, however many views are taken.
struct View {
  Eigen::Vector3f direction;
  std::uint64_t key;
};

/// `count` views in the order of time. The views for N are among those for 2 N: more views are more
/// samples, not other ones. Deterministic in `seed`.
std::vector<View> make_views(ViewSet views, std::size_t count, std::uint64_t seed);

/// Whether a direction lies in the sector that `gap` leaves out.
bool in_gap(const Eigen::Vector3f& direction);

/// Scattered directions for tests, from another stream than any training view.
std::vector<Eigen::Vector3f> test_directions(std::size_t count, std::uint64_t seed);

}  // namespace sheen::evaluation
