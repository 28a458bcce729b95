// SPDX-License-Identifier: MIT
#include "fitting/detail/detail_light_field.h"

#include <utility>

namespace sheen::fitting::detail {
namespace {

sparse::LightFieldModel no_offsets(std::size_t patch_count) {
  sparse::LightFieldModel offsets(patch_count);
  sparse::PatchModel zero;
  zero.coefficient[0].setZero();
  for (std::size_t patch = 0; patch < patch_count; ++patch) offsets.store(patch, zero);
  return offsets;
}

}  // namespace

DetailLightField::DetailLightField(const core::Mesh& mesh, core::Atlas atlas)
    : DetailLightField(mesh, SurfaceTexture(std::move(atlas)), no_offsets(mesh.positions.size())) {}

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
  return colour;
}

Eigen::Vector3f DetailLightField::mean_colour(std::size_t patch_idx) const {
  return texture_.read(place_[patch_idx]);
}

std::size_t DetailLightField::coefficient_count() const {
  const TexelCount& texels = texture_.texel_count();
  std::size_t count = 3 * (texels.offered > 0 ? texels.stored : texture_.texels().size());
  for (std::size_t patch = 0; patch < patch_count(); ++patch) {
    const sparse::PatchModel offset = offsets_.patch(patch);
    if (offset.term_count() > 1) count += 3 * offset.term_count() + offset.rbf_count;
  }
  return count;
}

}  // namespace sheen::fitting::detail
