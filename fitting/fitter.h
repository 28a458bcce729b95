// SPDX-License-Identifier: MIT
#pragma once

#include "core/samples/sample_batch.h"
#include "fitting/light_field.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace sheen::fitting {

/// What changed in a light field since the last call: patch indices, ascending, no repeats.
struct ModelUpdate {
  std::vector<std::uint32_t> patches;
};

/// Work done so far.
struct FitStatistics {
  std::size_t samples = 0;  ///< samples integrated
  std::size_t fits = 0;     ///< least-squares systems solved
  std::size_t patch_views =
      0;  ///< (patch, view) pairs seen: the denominator of fits per patch per view
  /// Error that the fit does not mind, sRGB, given or estimated; nothing where there is none.
  std::optional<float> tolerance{};
};

/// A light field under construction: takes the samples of one view after the other.
/// The result does not depend on the number of threads.
class Fitter {
 public:
  virtual ~Fitter() = default;

  /// Integrates one view. The returned reference is valid until the next call.
  virtual const ModelUpdate& integrate(const core::SampleBatch& batch) = 0;

  /// Solves what was put off and fills patches never seen from their neighbours. More views may
  /// be integrated afterwards; then call it again.
  virtual const ModelUpdate& finish() = 0;

  /// The model as of the last `integrate` or `finish`.
  [[nodiscard]] virtual const LightField& light_field() const = 0;

  [[nodiscard]] virtual FitStatistics statistics() const = 0;

  /// How wrong the model is likely to be for a patch towards a direction on its unit disc, >= 0, to
  /// rank places that need more views; nothing where the representation or the patch cannot tell.
  [[nodiscard]] virtual std::optional<float> predicted_error(std::size_t /*patch_idx*/,
                                                             const Eigen::Vector2f& /*uv*/) const {
    return std::nullopt;
  }
};

}  // namespace sheen::fitting
