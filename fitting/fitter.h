// SPDX-License-Identifier: MIT
#pragma once

#include "core/samples/observation.h"
#include "fitting/light_field.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace sheen::fitting {

/// What changed in a light field since the last call: indices of its elements
/// (LightField::element_count), ascending, no repeats.
struct ModelUpdate {
  std::vector<std::uint32_t> elements;
};

/// Work done so far.
struct FitStatistics {
  std::size_t samples = 0;  ///< samples integrated
  std::size_t fits = 0;     ///< least-squares systems solved
  std::size_t patch_views =
      0;  ///< (patch, view) pairs seen: the denominator of fits per patch per view
  /// Error that the fit does not mind, sRGB, given or estimated; nothing where there is none.
  std::optional<float> tolerance{};
  /// What `finish` chose where the choice was left to it, and why: a line. Empty: nothing.
  std::string choice{};
};

/// A light field under construction: integrates one observation after the other.
/// The result does not depend on the number of threads.
class Fitter {
 public:
  virtual ~Fitter() = default;

  /// Whether `integrate` looks at anything but the samples. Where it does not, nothing else of an
  /// observation need be kept for undo or for a comparison.
  [[nodiscard]] virtual bool needs_images() const { return true; }

  /// Whether `integrate` looks at depths that a sensor measured. Where it does not, they are not
  /// read.
  [[nodiscard]] virtual bool needs_depth() const { return false; }

  /// Integrates one view. The returned reference is valid until the next call.
  virtual const ModelUpdate& integrate(const core::Observation& observation) = 0;

  /// Solves what was put off and fills what was never seen from its neighbours. More views may be
  /// integrated afterwards; then call it again.
  virtual const ModelUpdate& finish() = 0;

  /// The model as of the last `integrate` or `finish`.
  [[nodiscard]] virtual const LightField& light_field() const = 0;

  [[nodiscard]] virtual FitStatistics statistics() const = 0;
};

}  // namespace sheen::fitting
