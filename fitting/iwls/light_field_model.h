// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/huge_pages.h"
#include "fitting/iwls/options.h"
#include "fitting/iwls/quad_kernels.h"
#include "fitting/patch_light_field.h"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace sheen::fitting::iwls {

/// Geometry shared by all patches of an IWLS model.
struct ModelShape {
  Layout layout = Layout::grid;
  std::vector<Eigen::Vector2f> centers;  ///< on or near the unit disc
  int terms = 3;                         ///< stored terms per centre: 1, 3 or 6
  float support_radius = 0;              ///< of every centre, in units of the disc
};

/// The light field of incremental weighted least squares: per patch one low-degree polynomial at
/// each centre, joined by a partition of unity (eqs. 6, 7). With d = (uv - centre) / support_radius
/// the terms are 1, d.u, d.v, d.u^2, d.u d.v, d.v^2.
class LightFieldModel final : public PatchLightField {
 public:
  /// Mid grey everywhere, nothing observed.
  LightFieldModel(ModelShape shape, std::size_t patch_count);

  /// `coefficients` as `coefficients_by_center()` returns them, all finite; one flag per patch.
  LightFieldModel(ModelShape shape, const std::vector<Eigen::half>& coefficients,
                  std::vector<std::uint8_t> observed);

  [[nodiscard]] std::string_view representation() const override { return "iwls"; }
  [[nodiscard]] std::size_t patch_count() const override { return observed_.size(); }
  [[nodiscard]] WeightedColour evaluate(std::size_t patch_idx,
                                        const Eigen::Vector2f& uv) const override;
  /// Mean of the constant terms of the centres inside the disc.
  [[nodiscard]] Eigen::Vector3f mean_colour(std::size_t patch_idx) const override;
  [[nodiscard]] const std::vector<std::uint8_t>& observed() const override { return observed_; }
  [[nodiscard]] std::size_t coefficient_count() const override {
    return observed_.size() * shape_.centers.size() * static_cast<std::size_t>(3 * shape_.terms);
  }

  [[nodiscard]] const ModelShape& shape() const { return shape_; }

  /// All coefficients as the model file holds them: [patch][centre][term][r, g, b].
  [[nodiscard]] std::vector<Eigen::half> coefficients_by_center() const;

  /// All coefficients as they are fitted, evaluated and drawn: [patch][quad][term][r, g, b][lane],
  /// four centres side by side, centre j in slot `slots_of_centers`[j] = 4 quad + lane. Where there
  /// is no centre, zeros.
  [[nodiscard]] std::span<const Eigen::half> coefficients() const { return coefficients_; }
  [[nodiscard]] std::span<const Eigen::half> coefficients(std::size_t patch_idx) const {
    return coefficients().subspan(patch_idx * per_patch_, per_patch_);
  }
  [[nodiscard]] std::size_t coefficients_per_patch() const { return per_patch_; }
  /// Positions of the slots; those without a centre stand where no support reaches.
  [[nodiscard]] std::span<const float> slots_u() const { return u_; }
  [[nodiscard]] std::span<const float> slots_v() const { return v_; }
  /// Coefficients of a patch for the fit, as bits.
  [[nodiscard]] std::uint16_t* slots_of(std::size_t patch_idx) {
    return &coefficients_.data()[patch_idx * per_patch_].x;
  }

  /// Stores one centre's polynomial ([term][r, g, b], `3 * terms` values), limited to what a half
  /// can hold. Returns whether a stored number changed. Patches may be written by different
  /// threads.
  bool store(std::size_t patch_idx, std::size_t center_idx, std::span<const double> values);
  /// Same for a constant at every centre.
  bool store_constant(std::size_t patch_idx, const Eigen::Vector3f& colour);
  /// Returns whether the flag changed.
  bool store_observed(std::size_t patch_idx, bool observed);

 private:
  [[nodiscard]] std::size_t values_per_center() const {
    return static_cast<std::size_t>(3 * shape_.terms);
  }
  /// Where a number of a centre's polynomial ([term][r, g, b]) stands.
  [[nodiscard]] std::size_t place(std::size_t patch_idx, std::size_t center_idx,
                                  std::size_t value) const;

  ModelShape shape_;
  std::vector<std::size_t> slots_;  ///< of the centres
  std::vector<float> u_, v_;        ///< of the slots
  Evaluate evaluate_;
  std::size_t per_patch_;
  std::vector<Eigen::half, HugePageAllocator<Eigen::half>> coefficients_;
  std::vector<std::uint8_t> observed_;
};

}  // namespace sheen::fitting::iwls
