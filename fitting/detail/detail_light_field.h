// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "fitting/patch_light_field.h"
#include "fitting/sparse/light_field_model.h"
#include "fitting/texture/surface_texture.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace sheen::fitting::detail {

/// A light field of two parts that are added up: a texture, the mean colour of every place, and
/// patches (one per vertex), how the colour differs from it towards every direction.
class DetailLightField final : public PatchLightField {
 public:
  /// Grey and without a texture until there is one.
  explicit DetailLightField(const core::Mesh& mesh);

  [[nodiscard]] std::string_view representation() const override { return "detail"; }
  [[nodiscard]] std::size_t patch_count() const override { return offsets_.patch_count(); }
  [[nodiscard]] WeightedColour evaluate(std::size_t patch_idx,
                                        const Eigen::Vector2f& uv) const override;
  [[nodiscard]] Eigen::Vector3f mean_colour(std::size_t patch_idx) const override;
  [[nodiscard]] const std::vector<std::uint8_t>& observed() const override {
    return offsets_.observed();
  }
  /// Three per texel, and those of the patches that are not zero.
  [[nodiscard]] std::size_t coefficient_count() const override;
  /// Patches, then pages of the texture.
  [[nodiscard]] std::size_t element_count() const override;

  [[nodiscard]] const sparse::LightFieldModel& offsets() const { return offsets_; }
  [[nodiscard]] sparse::LightFieldModel& offsets() { return offsets_; }
  [[nodiscard]] const std::optional<SurfaceTexture>& texture() const { return texture_; }
  [[nodiscard]] std::optional<SurfaceTexture>& texture() { return texture_; }

 private:
  /// A triangle that has a vertex at one of its corners.
  struct Corner {
    std::uint32_t triangle_idx;
    std::uint8_t corner;
  };

  [[nodiscard]] Eigen::Vector3f texture_at(std::size_t patch_idx) const;

  sparse::LightFieldModel offsets_;
  std::optional<SurfaceTexture> texture_;
  std::vector<std::optional<Corner>> corner_of_;  ///< nothing where no triangle uses the vertex
};

}  // namespace sheen::fitting::detail
