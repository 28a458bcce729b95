// SPDX-License-Identifier: MIT
#include "fitting/detail/detail_light_field.h"

namespace sheen::fitting::detail {

DetailLightField::DetailLightField(const core::Mesh& mesh)
    : offsets_(mesh.positions.size()), corner_of_(mesh.positions.size()) {
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint8_t corner = 0; corner < 3; ++corner) {
      auto& place = corner_of_[mesh.triangles[t][corner]];
      if (!place) place = Corner{t, corner};
    }
  }
  sparse::PatchModel nothing;
  nothing.coefficient[0].setZero();
  for (std::size_t patch = 0; patch < offsets_.patch_count(); ++patch) {
    offsets_.store(patch, nothing);
  }
}

Eigen::Vector3f DetailLightField::texture_at(std::size_t patch_idx) const {
  const auto& corner = corner_of_[patch_idx];
  if (!texture_ || !corner) return Eigen::Vector3f::Constant(0.5f);
  return texture_->read(texture_->atlas().place(corner->triangle_idx, corner->corner));
}

WeightedColour DetailLightField::evaluate(std::size_t patch_idx, const Eigen::Vector2f& uv) const {
  WeightedColour colour = offsets_.evaluate(patch_idx, uv);
  colour.colour_sum += colour.weight_sum * texture_at(patch_idx);
  return colour;
}

Eigen::Vector3f DetailLightField::mean_colour(std::size_t patch_idx) const {
  return texture_at(patch_idx);
}

std::size_t DetailLightField::coefficient_count() const {
  std::size_t count = texture_ ? 3 * texture_->texels().size() : 0;
  for (std::size_t patch = 0; patch < patch_count(); ++patch) {
    const sparse::PatchModel model = offsets_.patch(patch);
    if (model.term_count() > 1) count += 3 * model.term_count() + model.rbf_count;
  }
  return count;
}

std::size_t DetailLightField::element_count() const {
  return patch_count();
}

}  // namespace sheen::fitting::detail
