// SPDX-License-Identifier: MIT
#pragma once

#include "evaluation/comparison/measure_candidate.h"

#include <string>
#include <vector>

namespace sheen::evaluation {

/// On which fronts of accuracy against a cost a candidate stands: nobody is both as cheap and as
/// accurate.
struct Fronts {
  bool fit_time = false;
  bool render_time = false;
  bool bytes = false;
};

/// A candidate on a recording.
struct ComparedCandidate {
  std::string session;
  Candidate candidate;
  CandidateMeasurement measured;
  Fronts fronts;
};

/// A recording as it was used.
struct ComparedSession {
  std::string name;  ///< unique in the comparison
  std::string folder;
  std::size_t fitted_frames = 0;
  std::size_t held_out_views = 0;
  bool has_own_held_out = false;
};

/// A candidate that could not be measured on a recording, and why.
struct LeftOutCandidate {
  std::string session;
  std::string candidate;
  std::string reason;
};

/// Everything `sheen compare` found.
struct Comparison {
  std::vector<ComparedSession> sessions;
  std::vector<ComparedCandidate> rows;  ///< session by session, in the registry's order
  std::vector<LeftOutCandidate> left_out;
};

/// Sets the fronts of the rows of one session among each other.
void mark_fronts(std::span<ComparedCandidate> rows);

/// Means over the sessions of every candidate measured on all of them, fronts set; `session` is
/// empty. PSNR is averaged in dB.
std::vector<ComparedCandidate> averages(const Comparison& comparison);

/// Names for session folders: the folder's own name, the whole path where two would be the same.
std::vector<std::string> session_names(const std::vector<std::filesystem::path>& folders);

}  // namespace sheen::evaluation
