// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "fitting/detail/anchored_offsets.h"
#include "fitting/sparse/options.h"
#include "fitting/sparse/sparse_fitter.h"

#include <Eigen/Core>

#include <memory>
#include <vector>

namespace sheen::fitting::detail {

/// Offsets at anchors, and what they are on average.
struct FittedAnchors {
  /// Null: no anchor has anything to say.
  std::shared_ptr<const AnchoredOffsets> offsets;
  /// Mean over the views of every vertex, which a texture of mean colours holds already.
  std::vector<Eigen::Vector3f> mean;
};

/// Anchors as far apart as `spacing_m` (> 0), fitted to what the patches' samples differ by from
/// their means. An anchor's samples are those of all vertices that blend it; its terms are chosen
/// as a patch's are. Three sweeps over all anchors, each towards what the blends of the last one
/// leave. Of the two ways of asking them the one that leaves less after the first sweep is taken.
/// Anchors with which no vertex differs from zero are dropped. Takes 12 bytes for every kept
/// sample. The same on any number of threads.
FittedAnchors fit_anchors(const core::Mesh& mesh, const sparse::SparseFitter& patches,
                          float spacing_m, const sparse::Options& options, int threads);

}  // namespace sheen::fitting::detail
