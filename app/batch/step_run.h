// SPDX-License-Identifier: MIT
#pragma once

#include "app/batch/child_process.h"
#include "app/batch/failure.h"
#include "app/batch/session_work.h"
#include "core/files/staged_output.h"

#include <chrono>
#include <optional>
#include <string>

namespace sheen::app {

/// A step of a session while it runs. Without an end its outputs are removed.
class StepRun {
 public:
  /// Throws core::Error or std::filesystem::filesystem_error when it cannot begin.
  StepRun(const SessionWork& work, Step step, int threads);

  [[nodiscard]] Step step() const { return step_; }
  /// Becomes readable when the step has ended.
  [[nodiscard]] int handle() const { return child_->handle(); }

  enum class State { running, done, failed };
  /// Once ended, its outputs stand in their place, or `failure` says why not. Throws core::Error
  /// when they cannot be moved there.
  State state();
  [[nodiscard]] const Failure& failure() const { return failure_; }

 private:
  using Clock = std::chrono::steady_clock;
  const SessionWork& work_;
  Step step_;
  std::string made_from_;
  core::StagedOutput output_;
  std::optional<ChildProcess> child_;
  Clock::time_point start_ = Clock::now();
  Failure failure_;
};

}  // namespace sheen::app
