// SPDX-License-Identifier: MIT
#pragma once

#include "app/batch/step.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace sheen::app {

/// Words that are added to the commands of steps.
using StepWords = std::map<Step, std::vector<std::string>>;

/// A session of a batch and what is to be done with it.
struct Job {
  std::string name;              ///< of its folder in the output; no two are equal
  std::filesystem::path folder;  ///< of the session
  std::vector<Step> steps;       ///< in their order
  StepWords words;
  int parts = 1;  ///< of the patches, each replayed on its own; merged where there are several
};

/// What a session must reach, else it is listed as one that wants another walk.
struct Wanted {
  double psnr_db = 25;  ///< of held-out views, over all and per sector
  double seen = 0.9;    ///< share of the patches of a sector that some frame saw
  double posed = 0.7;   ///< share of the frames that got a pose
};

/// What a JOBS.yaml says (docs/batch.md).
struct Jobs {
  std::vector<Job> jobs;
  Wanted wanted;
  int hold_out = 8;             ///< every N-th frame is kept for evaluation; 0: none
  std::string format = "html";  ///< ending of what is exported
};

/// Reads a JOBS.yaml; its folders are relative to it. Throws core::Error (bad_input) that names the
/// file and the key: unknown keys, two sessions of one name, no sessions.
Jobs read_jobs(const std::filesystem::path& path);

}  // namespace sheen::app
