// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/patch_light_field.h"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace sheen::fitting::mean {

/// One colour per patch, the same in all directions: the smallest light field there is and the
/// yardstick for the others.
class MeanLightField final : public PatchLightField {
 public:
  /// Mid grey everywhere, nothing observed.
  explicit MeanLightField(std::size_t patch_count);

  /// Three finite coefficients and one flag per patch.
  MeanLightField(std::vector<Eigen::half> coefficients, std::vector<std::uint8_t> observed);

  [[nodiscard]] std::string_view representation() const override { return "mean"; }
  [[nodiscard]] std::size_t patch_count() const override { return observed_.size(); }
  [[nodiscard]] WeightedColour evaluate(std::size_t patch_idx,
                                        const Eigen::Vector2f& uv) const override;
  [[nodiscard]] Eigen::Vector3f mean_colour(std::size_t patch_idx) const override;
  [[nodiscard]] const std::vector<std::uint8_t>& observed() const override { return observed_; }
  [[nodiscard]] std::size_t coefficient_count() const override { return coefficients_.size(); }

  /// [patch][r, g, b], sRGB.
  [[nodiscard]] std::span<const Eigen::half> coefficients() const { return coefficients_; }

  /// Returns whether a stored number or the flag changed. Patches may be written by different
  /// threads.
  bool store(std::size_t patch_idx, const Eigen::Vector3f& colour, bool observed);

 private:
  std::vector<Eigen::half> coefficients_;
  std::vector<std::uint8_t> observed_;
};

}  // namespace sheen::fitting::mean
