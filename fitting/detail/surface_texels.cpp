// SPDX-License-Identifier: MIT
#include "fitting/detail/surface_texels.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <limits>

namespace sheen::fitting::detail {
namespace {

constexpr std::uint32_t kNobody = std::numeric_limits<std::uint32_t>::max();

struct Nearest {
  float squared = std::numeric_limits<float>::max();
  std::uint32_t triangle_idx = kNobody;
  float at_second = 0, at_third = 0;
};

/// Weights of the point of a triangle that lies nearest to `p`; on a side or in a corner for points
/// outside. Ericson, Real-Time Collision Detection, 5.1.5.
Eigen::Vector3f nearest_weights(const std::array<Eigen::Vector2f, 3>& corner,
                                const Eigen::Vector2f& p) {
  const Eigen::Vector2f ab = corner[1] - corner[0];
  const Eigen::Vector2f ac = corner[2] - corner[0];
  const Eigen::Vector2f ap = p - corner[0];
  const float d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const Eigen::Vector2f bp = p - corner[1];
  const float d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
  const Eigen::Vector2f cp = p - corner[2];
  const float d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const float w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0, 1 - w, w};
  }
  const float per = 1 / (va + vb + vc);
  return {va * per, vb * per, vc * per};
}

/// Offers a triangle to all texels within reach of a reading.
void offer(const core::Atlas& atlas, std::uint32_t triangle_idx, std::vector<Nearest>& nearest) {
  const std::array<Eigen::Vector2f, 3> corner{
      atlas.place(triangle_idx, 0), atlas.place(triangle_idx, 1), atlas.place(triangle_idx, 2)};
  const Eigen::Array2f least = corner[0].cwiseMin(corner[1]).cwiseMin(corner[2]).array() - 1.5f;
  const Eigen::Array2f most = corner[0].cwiseMax(corner[1]).cwiseMax(corner[2]).array() + 0.5f;
  const Eigen::Array2i first = least.ceil().cast<int>().cwiseMax(0);
  const Eigen::Array2i last =
      most.floor().cast<int>().cwiseMin(Eigen::Array2i(atlas.width - 1, atlas.height - 1));
  for (int y = first.y(); y <= last.y(); ++y) {
    for (int x = first.x(); x <= last.x(); ++x) {
      const Eigen::Vector2f centre(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
      const Eigen::Vector3f weights = nearest_weights(corner, centre);
      if (!weights.allFinite()) continue;  // a line seen as a triangle
      const Eigen::Vector2f off =
          weights[0] * corner[0] + weights[1] * corner[1] + weights[2] * corner[2] - centre;
      if (off.cwiseAbs().maxCoeff() > 1.0f) continue;
      Nearest& best = nearest[static_cast<std::size_t>(y) * static_cast<std::size_t>(atlas.width) +
                              static_cast<std::size_t>(x)];
      if (off.squaredNorm() >= best.squared) continue;
      best = {off.squaredNorm(), triangle_idx, weights[1], weights[2]};
    }
  }
}

}  // namespace

SurfaceTexels::SurfaceTexels(const core::Atlas& atlas) : offsets_(atlas.corners.size() + 1, 0) {
  std::vector<Nearest> nearest(atlas.texel_count());
  for (std::uint32_t t = 0; t < atlas.corners.size(); ++t) offer(atlas, t, nearest);
  // Sort them by triangle.
  for (const Nearest& one : nearest) {
    if (one.triangle_idx != kNobody) ++offsets_[one.triangle_idx + 1];
  }
  for (std::size_t i = 1; i < offsets_.size(); ++i) offsets_[i] += offsets_[i - 1];
  texels_.resize(offsets_.back() + 3);
  std::vector<std::uint32_t> next(offsets_.begin(), offsets_.end() - 1);
  for (std::uint32_t i = 0; i < nearest.size(); ++i) {
    const Nearest& one = nearest[i];
    if (one.triangle_idx == kNobody) continue;
    texels_[next[one.triangle_idx]++] = {i, one.at_second, one.at_third};
  }
}

}  // namespace sheen::fitting::detail
