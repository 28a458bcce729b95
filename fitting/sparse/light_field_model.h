// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/patch_light_field.h"
#include "fitting/sparse/patch_model.h"

#include <array>
#include <memory>
#include <vector>

namespace sheen::fitting::sparse {

/// The light field of sparse patches. A patch of one colour takes 16 bytes; every further term 8
/// more, in a block that grows with the patch and is kept when the patch shrinks.
class LightFieldModel final : public PatchLightField {
 public:
  /// Mid grey everywhere, nothing observed.
  explicit LightFieldModel(std::size_t patch_count);

  [[nodiscard]] std::string_view representation() const override { return "sparse"; }
  [[nodiscard]] std::size_t patch_count() const override { return slots_.size(); }
  [[nodiscard]] WeightedColour evaluate(std::size_t patch_idx,
                                        const Eigen::Vector2f& uv) const override;
  [[nodiscard]] Eigen::Vector3f mean_colour(std::size_t patch_idx) const override;
  [[nodiscard]] const std::vector<std::uint8_t>& observed() const override { return observed_; }
  /// Three per term and one per RBF's atom.
  [[nodiscard]] std::size_t coefficient_count() const override;

  /// Value of a patch towards `uv`, not clamped to [0, 1].
  [[nodiscard]] Eigen::Vector3f colour(std::size_t patch_idx, const Eigen::Vector2f& uv) const;

  /// The patch as stored: coefficients are half floats. Coefficients behind `term_count()` are
  /// unspecified.
  [[nodiscard]] PatchModel patch(std::size_t patch_idx) const;
  [[nodiscard]] std::size_t term_count(std::size_t patch_idx) const;

  /// Rounds to half floats and stores; all coefficients are finite. Returns whether a stored number
  /// changed. Different patches may be written by different threads.
  bool store(std::size_t patch_idx, const PatchModel& model);

  /// If the patch is one colour, moves it to the mean of `count` colours of which `rgb` is the
  /// last; otherwise as `store`.
  bool follow_mean(std::size_t patch_idx, const Eigen::Vector3f& rgb, std::size_t count);

  /// Returns whether the flag changed; threads as `store`.
  bool store_observed(std::size_t patch_idx, bool observed);

 private:
  using StoredColour = std::array<Eigen::half, 3>;
  struct Term {
    StoredColour colour;
    std::uint16_t atom;  ///< 0 for terms of the base
  };
  struct Slot {
    std::unique_ptr<Term[]> further;  ///< all terms but the constant
    StoredColour constant{};
    std::uint8_t shape = 0;     ///< RBF count; kLinearBit for the linear base
    std::uint8_t capacity = 0;  ///< of `further`
  };
  static constexpr std::uint8_t kLinearBit = 0x80;

  static StoredColour rounded(const Eigen::Vector3f& colour);
  static bool replace(StoredColour& place, const StoredColour& value);
  static std::size_t base_terms(const Slot& slot);
  static std::size_t rbf_count(const Slot& slot);
  static void reserve(Slot& slot, std::size_t further_terms);

  std::vector<Slot> slots_;
  std::vector<std::uint8_t> observed_;
};

}  // namespace sheen::fitting::sparse
