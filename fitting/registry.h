// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/neighbours.h"
#include "fitting/fitter.h"
#include "fitting/iwls/options.h"
#include "fitting/sparse/options.h"
#include "fitting/spherical_harmonics/options.h"

#include <memory>
#include <string>
#include <vector>

namespace sheen::fitting {

/// Everything a representation may be asked to respect.
struct FitOptions {
  iwls::Options iwls;
  int threads = 1;  ///< >= 1
  spherical_harmonics::Options spherical_harmonics{};
  sparse::Options sparse{};
};

/// Names in the order users should see them.
std::vector<std::string> representation_names();

/// An empty representation with one patch per vertex. Throws std::invalid_argument for an unknown
/// name.
std::unique_ptr<Fitter> make_fitter(const std::string& name,
                                    const core::VertexNeighbours& neighbours,
                                    const FitOptions& options);

}  // namespace sheen::fitting
