// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "fitting/detail/anchored_offsets.h"
#include "fitting/detail/check_directions.h"
#include "fitting/detail/triangle_samples.h"
#include "fitting/sparse/options.h"
#include "fitting/sparse/sparse_fitter.h"

#include <Eigen/Core>

#include <functional>
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

/// Whether anchors that were swept over a few times will do.
using IsEnough = std::function<bool(const AnchoredOffsets&)>;

/// Anchors on two levels, the finer ones as far apart as `spacing_m` (> 0), fitted to what the
/// samples of triangles differ by from their means. An anchor's samples are those of all triangles
/// that blend it, averaged where they ask it in about the same direction; its terms are chosen as a
/// patch's of this tolerance are. Sweeps over all anchors of a level, each towards what the blends
/// of all levels leave: four, and three more unless the first are enough. Of the two ways of asking
/// them the one that leaves less after the first sweep is taken. Takes 52 bytes for every fitted
/// sample, of each triangle a multiple of eight, and one for every anchor that blends there. The
/// same on any number of threads.
AnchoredOffsets fit_anchored_offsets(const core::Mesh& mesh, const TriangleSamples& samples,
                                     FittedDirections directions, float spacing_m,
                                     const sparse::Options& options, float tolerance, int threads,
                                     const IsEnough& is_enough);

/// The same to all samples, without anchors by which no vertex differs from zero. `patches` know
/// the views of the vertices.
FittedAnchors fit_anchors(const core::Mesh& mesh, const sparse::SparseFitter& patches,
                          const TriangleSamples& samples, float spacing_m,
                          const sparse::Options& options, int threads);

}  // namespace sheen::fitting::detail
