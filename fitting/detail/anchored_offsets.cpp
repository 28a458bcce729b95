// SPDX-License-Identifier: MIT
#include "fitting/detail/anchored_offsets.h"

#include "core/geometry/disc_map.h"

#include <cassert>
#include <utility>

namespace sheen::fitting::detail {

AnchoredOffsets::AnchoredOffsets(const core::Mesh& mesh, AnchorLayout layout, AskedDirection asked,
                                 sparse::LightFieldModel models)
    : layout_(std::move(layout)),
      asked_(asked),
      models_(std::move(models)),
      blends_(blend_anchors(mesh, layout_.vertices, layout_.spacing_m)),
      normals_(mesh.normals) {
  assert(models_.patch_count() == layout_.vertices.size());
}

Eigen::Vector3f AnchoredOffsets::colour(std::size_t vertex, const Eigen::Vector2f& uv) const {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  const AnchorBlend& blend = blends_[vertex];
  for (std::size_t i = 0; i < kMostBlended && blend.weight[i] > 0.0f; ++i) {
    if (models_.term_count(blend.anchor[i]) == 1) continue;
    sum += blend.weight[i] * models_.colour(blend.anchor[i], uv_at(blend.anchor[i], vertex, uv));
  }
  return sum;
}

// Mirroring at the vertex, less the sign: -r = w - 2 (n . w) n; mirroring at the anchor turns it
// once more and leaves -r on its tangent plane.
Eigen::Vector2f AnchoredOffsets::uv_at(std::size_t anchor, std::size_t vertex,
                                       const Eigen::Vector2f& uv) const {
  const core::TangentFrame seen = core::tangent_frame(normals_[vertex]);
  const core::TangentFrame frame = core::tangent_frame(normals_[layout_.vertices[anchor]]);
  const Eigen::Vector3f local = core::hemisphere_from_disc(uv);
  const float side = asked_ == AskedDirection::mirrored ? -1.0f : 1.0f;
  const Eigen::Vector3f w =
      local.x() * seen.tangent + local.y() * seen.bitangent + side * local.z() * seen.normal;
  const Eigen::Vector2f at(w.dot(frame.tangent), w.dot(frame.bitangent));
  // Behind the anchor's horizon: on the rim.
  return side * w.dot(frame.normal) < 0.0f && at.squaredNorm() > 0.0f ? at.normalized() : at;
}

}  // namespace sheen::fitting::detail
