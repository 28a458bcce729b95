// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/patch_light_field.h"

#include <Eigen/Core>

#include <array>
#include <span>
#include <vector>

namespace sheen::fitting::nearest_views {

/// One sample as it is kept: u, v, r, g, b.
using StoredSample = std::array<Eigen::half, 5>;

/// Every sample that was ever seen, and between them a blend of the k = 3 nearest directions,
/// weighted as in Buehler et al., "Unstructured Lumigraph Rendering" (2001): with the angles a_i to
/// the nearest and a_4 to the fourth, w_i = (1 - a_i / a_4) / a_i. Interpolates the samples, is
/// continuous, and costs ten bytes per sample: the yardstick for what models save.
class LightFieldModel final : public PatchLightField {
 public:
  /// No samples, nothing observed: mid grey everywhere.
  explicit LightFieldModel(std::size_t patch_count);

  /// `samples` of all patches, one list each, all finite; one flag per patch.
  LightFieldModel(std::vector<std::vector<StoredSample>> samples,
                  std::vector<std::uint8_t> observed);

  [[nodiscard]] std::string_view representation() const override { return "nearest-views"; }
  [[nodiscard]] std::size_t patch_count() const override { return observed_.size(); }
  [[nodiscard]] WeightedColour evaluate(std::size_t patch_idx,
                                        const Eigen::Vector2f& uv) const override;
  /// Mean of the samples.
  [[nodiscard]] Eigen::Vector3f mean_colour(std::size_t patch_idx) const override;
  [[nodiscard]] const std::vector<std::uint8_t>& observed() const override { return observed_; }
  /// Five per sample.
  [[nodiscard]] std::size_t coefficient_count() const override;

  [[nodiscard]] std::span<const StoredSample> samples(std::size_t patch_idx) const {
    return samples_[patch_idx];
  }

  /// Adds a sample, all finite; the patch is observed from then on and loses a colour that
  /// `store_unseen` gave it. Different patches may be written by different threads.
  void add(std::size_t patch_idx, const Eigen::Vector2f& uv, const Eigen::Vector3f& colour);

  /// Gives a patch that is not observed one colour for all directions. Returns whether a stored
  /// number changed.
  bool store_unseen(std::size_t patch_idx, const Eigen::Vector3f& colour);

 private:
  std::vector<std::vector<StoredSample>> samples_;
  std::vector<std::uint8_t> observed_;
};

}  // namespace sheen::fitting::nearest_views
