// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/fitter.h"
#include "fitting/option_table.h"
#include "fitting/patch_light_field.h"

#include <Eigen/Core>

#include <cstddef>
#include <memory>
#include <optional>
#include <string_view>

namespace sheen::fitting {

/// A fitter of patches, each fitted to its own samples and to nothing else.
class PatchFitter : public Fitter {
 public:
  [[nodiscard]] bool needs_images() const final { return false; }
  const ModelUpdate& integrate(const core::Observation& observation) final {
    return integrate_samples(observation.samples);
  }

  /// Integrates the samples of one view.
  const ModelUpdate& integrate(const core::SampleBatch& batch) { return integrate_samples(batch); }

  [[nodiscard]] const PatchLightField& light_field() const override = 0;

  /// How wrong the model is likely to be for a patch towards a direction on its unit disc, >= 0, to
  /// rank places that need more views; nothing where the representation or the patch cannot tell.
  [[nodiscard]] virtual std::optional<float> predicted_error(std::size_t /*patch_idx*/,
                                                             const Eigen::Vector2f& /*uv*/) const {
    return std::nullopt;
  }

 private:
  virtual const ModelUpdate& integrate_samples(const core::SampleBatch& batch) = 0;
};

/// An empty light field of so many patches that have no neighbours, for studies of single patches.
/// Throws std::invalid_argument as `make_fitter` does, and when the representation has no patches.
std::unique_ptr<PatchFitter> make_isolated_patches(std::string_view representation,
                                                   std::size_t patch_count,
                                                   const OptionValues& values = {},
                                                   int threads = 1);

}  // namespace sheen::fitting
