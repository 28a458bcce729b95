// SPDX-License-Identifier: MIT
#pragma once

#include "app/batch/jobs_file.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace sheen::app {

/// The steps of one session: where their outputs lie, what runs them, which are up to date.
///
/// Every step has a folder of its name in the session's output folder, which appears complete or
/// not at all. Survey and register leave the recording as it is: they make a session folder of
/// links to it, in which the file that they found anew lies as a file.
class SessionWork {
 public:
  /// `folder` is the session's output folder.
  SessionWork(const Jobs& jobs, const Job& job, std::filesystem::path folder);

  [[nodiscard]] const Job& job() const { return job_; }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  /// Those that apply to this session: the tags of one with given poses are not surveyed.
  [[nodiscard]] const std::vector<Step>& steps() const { return steps_; }
  [[nodiscard]] std::filesystem::path folder_of(Step step) const;

  /// Steps that must run: their outputs are missing or were made from other input. Looks at names,
  /// sizes and times of the recording's files.
  [[nodiscard]] std::vector<Step> out_of_date() const;

  /// The arguments of the program that make the step's outputs in `output`, an empty folder, which
  /// is prepared for it. Throws core::Error, std::filesystem::filesystem_error.
  [[nodiscard]] std::vector<std::string> prepare(Step step, const std::filesystem::path& output,
                                                 int threads) const;

  /// What the step's outputs are made from now, as a hash.
  [[nodiscard]] std::string fingerprint(Step step) const;

  /// Leaves a note in `output` of what it was made from (taken before the step ran) and how long it
  /// took.
  static void record(Step step, const std::filesystem::path& output, const std::string& made_from,
                     double seconds);

 private:
  /// The session that a step works on: the recording, or the links of the step before.
  [[nodiscard]] std::filesystem::path session_before(Step step) const;
  [[nodiscard]] std::string fingerprint(Step step, const std::string& recording) const;

  Job job_;
  std::filesystem::path folder_;
  std::vector<Step> steps_;
  int hold_out_;
  std::string format_;
};

}  // namespace sheen::app
