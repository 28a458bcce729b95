// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/light_field.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sheen::fitting {

class SurfaceTexture;

/// Weight with which a patch that was never seen enters the interpolation across a triangle: small
/// enough that any seen neighbour decides, large enough to divide by.
inline constexpr float kUnseenWeight = 1.0f / 1024.0f;

/// Numerator and denominator of the partition of unity (eq. 7). Both are interpolated across a
/// triangle and divided per pixel; weight > 0 always.
struct WeightedColour {
  Eigen::Vector3f colour_sum;  ///< sum_j theta_j P_j, display-referred sRGB
  float weight_sum;            ///< sum_j theta_j

  /// What is shown, before the limits of the display.
  [[nodiscard]] Eigen::Vector3f colour() const { return colour_sum / weight_sum; }
};

/// A light field of patches, one per vertex of the mesh, each a function of the direction it is
/// seen from.
class PatchLightField : public LightField {
 public:
  [[nodiscard]] virtual std::size_t patch_count() const = 0;

  /// Radiance of a patch towards a direction on its unit disc.
  [[nodiscard]] virtual WeightedColour evaluate(std::size_t patch_idx,
                                                const Eigen::Vector2f& uv) const = 0;

  /// Colour that is added, at a place on a triangle, to what patches interpolate to there: towards
  /// `w`, unit vector in the object frame.
  [[nodiscard]] virtual Eigen::Vector3f between_patches(std::size_t /*triangle_idx*/,
                                                        const Eigen::Vector3f& /*barycentric*/,
                                                        const Eigen::Vector3f& /*w*/) const {
    return Eigen::Vector3f::Zero();
  }
  /// The part of it that is the same towards every direction; null: none.
  [[nodiscard]] virtual const SurfaceTexture* texture_between_patches() const { return nullptr; }
  /// What is interpolated: `evaluate` without what lies between.
  [[nodiscard]] virtual WeightedColour interpolated_part(std::size_t patch_idx,
                                                         const Eigen::Vector2f& uv) const {
    return evaluate(patch_idx, uv);
  }

  /// Direction-independent colour of a patch, sRGB in [0, 1].
  [[nodiscard]] virtual Eigen::Vector3f mean_colour(std::size_t patch_idx) const = 0;

  /// 1 where the patch was seen in the fit, 0 where its colour comes from neighbours.
  [[nodiscard]] virtual const std::vector<std::uint8_t>& observed() const = 0;

  [[nodiscard]] std::size_t element_count() const override { return patch_count(); }
  [[nodiscard]] std::vector<Eigen::Vector3f> vertex_colours(const core::Mesh& mesh) const override;
};

/// The light field as one of patches, null when it is another kind.
const PatchLightField* as_patches(const LightField& light_field);

/// The same for whoever needs patches: throws core::Error (bad_input) that says `purpose` ("undo",
/// "the alignment of poses") needs a representation of patches.
const PatchLightField& require_patches(const LightField& light_field, std::string_view purpose);

}  // namespace sheen::fitting
