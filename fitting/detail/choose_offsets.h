// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "fitting/detail/triangle_samples.h"
#include "fitting/sparse/options.h"
#include "fitting/sparse/sparse_fitter.h"

#include <cmath>

namespace sheen::fitting::detail {

/// How far off offsets at vertices and at anchors are in directions that neither was fitted to:
/// root mean squares of what triangles' colours differ by from their means, sRGB; 0 where no
/// direction could be checked.
struct OffsetErrors {
  double vertex = 0, anchors = 0;

  /// By how much anchors are better.
  [[nodiscard]] double difference_db() const { return 20 * std::log10(vertex / anchors); }
  /// Where they predict as well they are taken: they need fewer bytes.
  [[nodiscard]] bool anchors_win() const { return anchors > 0 && anchors <= vertex; }
};

/// Fits both to the samples that are no checks (check_directions.h) and predicts the others. Takes
/// what a `finish` with anchors takes, time and memory. The same on any number of threads.
OffsetErrors check_offsets(const core::Mesh& mesh, const sparse::SparseFitter& patches,
                           const TriangleSamples& samples, float spacing_m,
                           const sparse::Options& options, int threads);

}  // namespace sheen::fitting::detail
