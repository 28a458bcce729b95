// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/neighbours.h"
#include "fitting/patch_fitter.h"
#include "fitting/sparse/light_field_model.h"
#include "fitting/sparse/options.h"
#include "fitting/sparse/sample_store.h"

#include <cstddef>
#include <memory>
#include <vector>

namespace sheen::fitting::sparse {

/// A sample as it is kept.
struct KeptSample {
  DirectedColour sample;
  float weight;  ///< samples that were averaged into it times the squared cosine
};

/// A fitter of sparse patches.
class SparseFitter : public PatchFitter {
 public:
  [[nodiscard]] const LightFieldModel& light_field() const override = 0;

  /// Mean colour that a patch's model has towards the views it was seen from, weighted with the
  /// squared cosines at which they saw it; zero for a patch never seen.
  [[nodiscard]] virtual Eigen::Vector3f mean_over_views(std::size_t patch_idx) const = 0;

  /// What the views showed of a patch, at most kMaxStoredSamples of it.
  [[nodiscard]] virtual std::vector<KeptSample> samples_of(std::size_t patch_idx) const = 0;
};

/// Patches with as many terms as their samples ask for: one colour, a linear base, RBFs
/// (patch_model.h). While views arrive a patch is looked at again when a sample was predicted badly
/// or its samples have grown by a third; `finish` chooses the terms of every touched patch anew,
/// which makes the result independent of the order of views as long as all samples are kept.
/// `threads` >= 1. Throws std::invalid_argument for bad options.
std::unique_ptr<SparseFitter> make_sparse_fitter(const core::VertexNeighbours& neighbours,
                                                 const Options& options, int threads);

}  // namespace sheen::fitting::sparse
