// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/patch_light_field.h"
#include "fitting/spherical_harmonics/basis.h"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace sheen::fitting::spherical_harmonics {

/// Spherical harmonics per patch, evaluated on the direction (u, v, sqrt(1 - u^2 - v^2)) of the
/// patch's tangent frame: what Gaussian splats and most light field baselines use.
class LightFieldModel final : public PatchLightField {
 public:
  /// Mid grey everywhere, nothing observed. `degree` is 1, 2 or 3.
  LightFieldModel(int degree, std::size_t patch_count);

  /// `coefficients` as `coefficients()` returns them, all finite; one flag per patch.
  LightFieldModel(int degree, std::vector<Eigen::half> coefficients,
                  std::vector<std::uint8_t> observed);

  [[nodiscard]] std::string_view representation() const override { return "sh"; }
  [[nodiscard]] std::size_t patch_count() const override { return observed_.size(); }
  [[nodiscard]] WeightedColour evaluate(std::size_t patch_idx,
                                        const Eigen::Vector2f& uv) const override;
  [[nodiscard]] Eigen::Vector3f mean_colour(std::size_t patch_idx) const override;
  [[nodiscard]] const std::vector<std::uint8_t>& observed() const override { return observed_; }
  [[nodiscard]] std::size_t coefficient_count() const override { return coefficients_.size(); }

  [[nodiscard]] int degree() const { return degree_; }

  /// [patch][term][r, g, b], sRGB.
  [[nodiscard]] std::span<const Eigen::half> coefficients() const { return coefficients_; }
  /// [term][r, g, b] of one patch.
  [[nodiscard]] std::span<const Eigen::half> coefficients(std::size_t patch_idx) const {
    return coefficients().subspan(patch_idx * per_patch_, per_patch_);
  }

  /// Rounds and stores [term][r, g, b], all finite; returns whether a stored number changed.
  /// Different patches may be written by different threads.
  bool store(std::size_t patch_idx, std::span<const double> values);
  bool store_constant(std::size_t patch_idx, const Eigen::Vector3f& colour);
  bool store_observed(std::size_t patch_idx, bool observed);

 private:
  int degree_;
  std::size_t per_patch_;
  std::vector<Eigen::half> coefficients_;
  std::vector<std::uint8_t> observed_;
};

}  // namespace sheen::fitting::spherical_harmonics
