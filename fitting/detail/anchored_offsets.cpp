// SPDX-License-Identifier: MIT
#include "fitting/detail/anchored_offsets.h"

#include "core/geometry/disc_map.h"
#include "core/mesh/interpolation.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

namespace sheen::fitting::detail {
namespace {

constexpr std::uint32_t kNoCorner = std::numeric_limits<std::uint32_t>::max();

}  // namespace

AnchoredOffsets::AnchoredOffsets(const core::Mesh& mesh, std::vector<AnchorLevel> levels,
                                 AskedDirection asked, sparse::LightFieldModel models)
    : mesh_(mesh),
      levels_(std::move(levels)),
      asked_(asked),
      models_(std::move(models)),
      first_{0},
      before_{0},
      corner_of_(mesh.positions.size(), kNoCorner) {
  std::vector<std::vector<AnchorBlend>> of_levels;
  for (const AnchorLevel& level : levels_) {
    of_levels.push_back(blend_anchors(mesh, level.vertices, level.spacing_m));
    first_.push_back(first_.back() + level.vertices.size());
    for (const std::uint32_t vertex : level.vertices) {
      frames_.push_back(core::tangent_frame(mesh.normals[vertex]));
    }
  }
  assert(models_.patch_count() == first_.back());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t l = 0; l < levels_.size(); ++l) {
      const std::size_t begin = blends_.size();
      for (std::uint32_t corner = 0; corner < 3; ++corner) {
        const std::uint32_t vertex = mesh.triangles[t][corner];
        corner_of_[vertex] = 3 * t + corner;
        const AnchorBlend& blend = of_levels[l][vertex];
        for (std::size_t i = 0; i < kMostBlended && blend.weight[i] > 0.0f; ++i) {
          const auto anchor = static_cast<std::uint32_t>(first_[l] + blend.anchor[i]);
          auto at =
              std::find_if(blends_.begin() + static_cast<std::ptrdiff_t>(begin), blends_.end(),
                           [&](const CornerWeights& other) { return other.anchor == anchor; });
          if (at == blends_.end()) at = blends_.insert(blends_.end(), CornerWeights{anchor, {}});
          at->weight[corner] = blend.weight[i];
        }
      }
      std::sort(blends_.begin() + static_cast<std::ptrdiff_t>(begin), blends_.end(),
                [](const auto& a, const auto& b) { return a.anchor < b.anchor; });
    }
    before_.push_back(static_cast<std::uint32_t>(blends_.size()));
  }
}

Eigen::Vector3f AnchoredOffsets::colour(std::size_t triangle, const Eigen::Vector3f& barycentric,
                                        const Eigen::Vector3f& w) const {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  const Eigen::Vector3f n = core::normal_on(mesh_, triangle, barycentric);
  for (const CornerWeights& blend : blends(triangle)) {
    if (models_.term_count(blend.anchor) == 1) continue;
    sum += blend.at(barycentric) * models_.colour(blend.anchor, uv_at(blend.anchor, n, w));
  }
  return sum;
}

void AnchoredOffsets::add(std::size_t triangle, const Eigen::Vector3f& barycentric,
                          const DirectionRows& w, const ColourRows& sum) const {
  for (std::size_t level = 0; level < levels_.size(); ++level) {
    add_level(level, triangle, barycentric, w, sum);
  }
}

void AnchoredOffsets::add_level(std::size_t level, std::size_t triangle,
                                const Eigen::Vector3f& barycentric, const DirectionRows& w,
                                const ColourRows& sum) const {
  const Eigen::Vector3f n = core::normal_on(mesh_, triangle, barycentric);
  for (const CornerWeights& blend : blends(triangle)) {
    if (blend.anchor < first_[level] || blend.anchor >= first_[level + 1]) continue;
    if (models_.term_count(blend.anchor) == 1) continue;
    add_patch(asked_patch(blend.anchor, n), models_.patch(blend.anchor), blend.at(barycentric), w,
              sum);
  }
}

void AnchoredOffsets::add_at(std::size_t vertex, const DirectionRows& w,
                             const ColourRows& sum) const {
  if (corner_of_[vertex] == kNoCorner) return;
  add(corner_of_[vertex] / 3, Eigen::Vector3f::Unit(corner_of_[vertex] % 3), w, sum);
}

Eigen::Vector3f AnchoredOffsets::colour_at(std::size_t vertex, const Eigen::Vector2f& uv) const {
  if (corner_of_[vertex] == kNoCorner) return Eigen::Vector3f::Zero();
  const core::TangentFrame frame = core::tangent_frame(mesh_.normals[vertex]);
  return colour(corner_of_[vertex] / 3, Eigen::Vector3f::Unit(corner_of_[vertex] % 3),
                frame.in_object(core::hemisphere_from_disc(uv)));
}

// Mirroring at the place, less the sign: -r = w - 2 (n . w) n; mirroring at the anchor turns it
// once more and leaves -r on its tangent plane.
Eigen::Vector2f AnchoredOffsets::uv_at(std::size_t anchor, const Eigen::Vector3f& n,
                                       const Eigen::Vector3f& w) const {
  const core::TangentFrame& frame = frames_[anchor];
  const float side = asked_ == AskedDirection::mirrored ? -1.0f : 1.0f;
  const Eigen::Vector3f v = side < 0.0f ? Eigen::Vector3f(w - 2.0f * n.dot(w) * n) : w;
  const Eigen::Vector2f at(v.dot(frame.tangent), v.dot(frame.bitangent));
  // Behind the anchor's horizon: on the rim.
  return side * v.dot(frame.normal) < 0.0f && at.squaredNorm() > 0.0f ? at.normalized() : at;
}

}  // namespace sheen::fitting::detail
