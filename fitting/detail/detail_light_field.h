// SPDX-License-Identifier: MIT
#pragma once

#include "core/atlas/atlas.h"
#include "core/mesh/mesh.h"
#include "fitting/detail/anchored_offsets.h"
#include "fitting/patch_light_field.h"
#include "fitting/sparse/light_field_model.h"
#include "fitting/texture/surface_texture.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace sheen::fitting::detail {

/// Patches that say nothing, one for each of the flags, which say whether it was observed.
sparse::LightFieldModel no_offsets(std::span<const std::uint8_t> observed);

/// A light field of two parts that are added up: a texture, the mean colour of every place, and
/// how the colour differs from it towards every direction: patches, one per vertex, or blended from
/// anchors.
class DetailLightField final : public PatchLightField {
 public:
  /// Mid grey, and the same towards every direction. `atlas` is one of `mesh`.
  DetailLightField(const core::Mesh& mesh, core::Atlas atlas);
  /// Of its parts, as a file holds them.
  DetailLightField(const core::Mesh& mesh, SurfaceTexture texture, sparse::LightFieldModel offsets);

  [[nodiscard]] std::string_view representation() const override { return "detail"; }
  [[nodiscard]] std::size_t patch_count() const override { return offsets_.patch_count(); }
  [[nodiscard]] WeightedColour evaluate(std::size_t patch_idx,
                                        const Eigen::Vector2f& uv) const override;
  [[nodiscard]] WeightedColour interpolated_part(std::size_t patch_idx,
                                                 const Eigen::Vector2f& uv) const override {
    return offsets_.evaluate(patch_idx, uv);
  }
  [[nodiscard]] Eigen::Vector3f between_patches(std::size_t triangle_idx,
                                                const Eigen::Vector3f& barycentric,
                                                const Eigen::Vector3f& w) const override;
  [[nodiscard]] Eigen::Vector3f mean_colour(std::size_t patch_idx) const override;
  [[nodiscard]] const std::vector<std::uint8_t>& observed() const override {
    return offsets_.observed();
  }
  /// Three per colour of the texture, and those of the patches that differ from zero.
  [[nodiscard]] std::size_t coefficient_count() const override;
  /// Patches, then pages of the texture.
  [[nodiscard]] std::size_t element_count() const override {
    return patch_count() + texture_.page_count();
  }

  [[nodiscard]] const SurfaceTexture* texture_between_patches() const override { return &texture_; }
  [[nodiscard]] const SurfaceTexture& texture() const { return texture_; }
  [[nodiscard]] SurfaceTexture& texture() { return texture_; }
  [[nodiscard]] const sparse::LightFieldModel& offsets() const { return offsets_; }
  [[nodiscard]] sparse::LightFieldModel& offsets() { return offsets_; }
  /// Added to the offsets, which are zero then; null: none.
  [[nodiscard]] const std::shared_ptr<const AnchoredOffsets>& anchors() const { return anchors_; }
  void set_anchors(std::shared_ptr<const AnchoredOffsets> anchors) {
    anchors_ = std::move(anchors);
  }

 private:
  SurfaceTexture texture_;
  sparse::LightFieldModel offsets_;
  std::shared_ptr<const AnchoredOffsets> anchors_;
  std::vector<Eigen::Vector2f> place_;  ///< of every vertex on the atlas, one of them
};

}  // namespace sheen::fitting::detail
