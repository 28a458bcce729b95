// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/registry.h"

#include <memory>
#include <string>
#include <vector>

namespace sheen::app {

/// One way to model the samples of a recording, as `sheen compare` measures it.
struct Candidate {
  const char* name;            ///< as --only and the CSV spell it, e.g. "sh3"
  const char* label;           ///< as people read it, e.g. "spherical harmonics 3"
  const char* family;          ///< candidates drawn in one colour, e.g. "Spherical harmonics"
  const char* representation;  ///< name in fitting's registry
  void (*choose)(fitting::FitOptions&);  ///< sets what makes this candidate itself
};

/// Every candidate whose representation is registered, from the simplest to the richest.
std::vector<Candidate> all_candidates();

/// Those named, in the registry's order; all when `names` is empty. Names must be known.
std::vector<Candidate> candidates_named(const std::vector<std::string>& names);

std::vector<std::string> candidate_names();

/// Empty, one patch per vertex. `threads` >= 1.
std::unique_ptr<fitting::Fitter> make_fitter(const Candidate& candidate,
                                             const core::VertexNeighbours& neighbours, int threads);

}  // namespace sheen::app
