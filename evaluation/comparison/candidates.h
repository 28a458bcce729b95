// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/option_table.h"

#include <string>
#include <vector>

namespace sheen::evaluation {

/// One way to model the samples of a recording, as `sheen compare` measures it.
struct Candidate {
  std::string name;                 ///< as --only and the CSV spell it, e.g. "sh3"
  std::string label;                ///< as people read it, e.g. "spherical harmonics 3"
  std::string family;               ///< candidates drawn in one colour, e.g. "Spherical harmonics"
  std::string representation;       ///< name of its descriptor
  fitting::OptionValues options{};  ///< what makes this candidate itself
};

/// Every candidate, from the simplest to the richest; representations that have none of their own
/// here (a program has added them) come last, with their defaults.
std::vector<Candidate> all_candidates();

/// Those named, in the registry's order; all when `names` is empty. Names must be known.
std::vector<Candidate> candidates_named(const std::vector<std::string>& names);

std::vector<std::string> candidate_names();

}  // namespace sheen::evaluation
