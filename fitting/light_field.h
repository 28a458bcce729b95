// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace sheen::fitting {

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

/// A fitted surface light field: what is drawn, saved and exported. Every representation's model is
/// one; numbers are held in the 16-bit precision of the model file, so that what is drawn, what is
/// measured and what is saved are the same.
class LightField {
 public:
  virtual ~LightField() = default;

  /// Name in the registry and in the model file, e.g. "iwls".
  [[nodiscard]] virtual std::string_view representation() const = 0;

  [[nodiscard]] virtual std::size_t patch_count() const = 0;

  /// Radiance of a patch towards a direction on its unit disc.
  [[nodiscard]] virtual WeightedColour evaluate(std::size_t patch_idx,
                                                const Eigen::Vector2f& uv) const = 0;

  /// Direction-independent colour of a patch, sRGB in [0, 1]: what plain mesh viewers show.
  [[nodiscard]] virtual Eigen::Vector3f mean_colour(std::size_t patch_idx) const = 0;

  /// 1 where the patch was seen in the fit, 0 where its colour comes from neighbours.
  [[nodiscard]] virtual const std::vector<std::uint8_t>& observed() const = 0;

  /// Stored numbers of all patches; each colour channel counts, a stored index counts as one.
  [[nodiscard]] virtual std::size_t coefficient_count() const = 0;
};

}  // namespace sheen::fitting
