// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/neighbours.h"
#include "fitting/mean/mean_fitter.h"
#include "fitting/mean/mean_light_field.h"

#include <memory>

namespace sheen::fitting {

/// The mean colours of the vertices that a model of photographs keeps beside them.
class MeanKeeper {
 public:
  MeanKeeper(const core::Mesh& mesh, int threads)
      : fitter_(mean::make_mean_fitter(core::vertex_neighbours(mesh), threads)) {}

  void integrate(const core::Observation& observation) {
    static_cast<Fitter&>(*fitter_).integrate(observation);
  }
  /// Fills what was never seen.
  void finish() { fitter_->finish(); }

  [[nodiscard]] const mean::MeanLightField& means() const {
    return dynamic_cast<const mean::MeanLightField&>(fitter_->light_field());
  }
  [[nodiscard]] FitStatistics statistics() const { return fitter_->statistics(); }

 private:
  std::unique_ptr<PatchFitter> fitter_;
};

}  // namespace sheen::fitting
