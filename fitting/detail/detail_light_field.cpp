// SPDX-License-Identifier: MIT
#include "fitting/detail/detail_light_field.h"

#include <utility>

namespace sheen::fitting::detail {
namespace {

/// Stored numbers; patches of one term are zero and have none.
std::size_t numbers_of(const sparse::LightFieldModel& offsets) {
  std::size_t count = 0;
  for (std::size_t patch = 0; patch < offsets.patch_count(); ++patch) {
    const sparse::PatchModel offset = offsets.patch(patch);
    if (offset.term_count() > 1) count += 3 * offset.term_count() + offset.rbf_count;
  }
  return count;
}

}  // namespace

sparse::LightFieldModel no_offsets(std::span<const std::uint8_t> observed) {
  sparse::LightFieldModel offsets(observed.size());
  sparse::PatchModel zero;
  zero.coefficient[0].setZero();
  for (std::size_t patch = 0; patch < observed.size(); ++patch) {
    offsets.store(patch, zero);
    offsets.store_observed(patch, observed[patch] != 0);
  }
  return offsets;
}

DetailLightField::DetailLightField(const core::Mesh& mesh, core::Atlas atlas)
    : DetailLightField(mesh, SurfaceTexture(std::move(atlas)),
                       no_offsets(std::vector<std::uint8_t>(mesh.positions.size(), 0))) {}

DetailLightField::DetailLightField(const core::Mesh& mesh, SurfaceTexture texture,
                                   sparse::LightFieldModel offsets)
    : texture_(std::move(texture)),
      offsets_(std::move(offsets)),
      place_(mesh.positions.size(), Eigen::Vector2f::Zero()) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      place_[mesh.triangles[t][static_cast<Eigen::Index>(corner)]] =
          texture_.atlas().place(t, corner);
    }
  }
}

WeightedColour DetailLightField::evaluate(std::size_t patch_idx, const Eigen::Vector2f& uv) const {
  WeightedColour colour = interpolated_part(patch_idx, uv);
  colour.colour_sum += colour.weight_sum * texture_.read(place_[patch_idx]);
  if (anchors_) colour.colour_sum += colour.weight_sum * anchors_->colour_at(patch_idx, uv);
  return colour;
}

Eigen::Vector3f DetailLightField::between_patches(std::size_t triangle_idx,
                                                  const Eigen::Vector3f& barycentric,
                                                  const Eigen::Vector3f& w) const {
  Eigen::Vector3f colour = texture_.at(triangle_idx, barycentric);
  if (anchors_) colour += anchors_->colour(triangle_idx, barycentric, w);
  return colour;
}

Eigen::Vector3f DetailLightField::mean_colour(std::size_t patch_idx) const {
  return texture_.read(place_[patch_idx]);
}

std::size_t DetailLightField::coefficient_count() const {
  const TexelCount& texels = texture_.texel_count();
  const std::size_t colours = texels.offered > 0 ? texels.stored : texture_.texels().size();
  return 3 * colours + numbers_of(offsets_) + (anchors_ ? numbers_of(anchors_->models()) : 0);
}

}  // namespace sheen::fitting::detail
