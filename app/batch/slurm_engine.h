// SPDX-License-Identifier: MIT
#pragma once

#include "app/batch/failure.h"
#include "app/batch/session_work.h"
#include "app/commands/command_context.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace sheen::app {

struct SlurmEngine {
  std::filesystem::path jobs_file;
  std::filesystem::path output;    ///< on a file system that all nodes see, as are the sessions
  std::vector<std::string> words;  ///< more options for sbatch: partition, time, CPUs
  Step until = kAllSteps.back();   ///< the last step that is run
};

/// Runs what is missing of every session by Slurm: one job array per step with a task per session,
/// which begins when that session's task of the step before has ended well, and for a replay in
/// parts an array per part, side by side before the one that merges. A task runs `sheen batch
/// --number K --until STEP` on its node, with --part N for a part. Waits for the end. Throws
/// core::Error (run_failed) when sbatch fails; Interrupted leaves the jobs in the queue, where the
/// next run finds them.
Failures run_on_slurm(std::span<const SessionWork> sessions, const SlurmEngine& engine,
                      const CommandContext& context);

}  // namespace sheen::app
