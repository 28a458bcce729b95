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
///
/// A replay in parts is made by works of their own, one per part; the session's merges what they
/// leave.
class SessionWork {
 public:
  /// `folder` is the session's output folder.
  SessionWork(const Jobs& jobs, const Job& job, std::filesystem::path folder);

  [[nodiscard]] const Job& job() const { return job_; }
  /// Of its outputs and its lock: the session's, or that of a part within it.
  [[nodiscard]] std::filesystem::path folder() const;
  /// Those that apply to this session: the tags of one with given poses are not surveyed.
  [[nodiscard]] const std::vector<Step>& steps() const { return steps_; }
  /// The works of its parts, in their order; none where the replay is not divided.
  [[nodiscard]] std::vector<SessionWork> parts() const;
  [[nodiscard]] std::filesystem::path folder_of(Step step) const;

  /// Steps that must run: their outputs are missing or were made from other input. Looks at names,
  /// sizes and times of the recording's files. A part is not missing once it was merged.
  [[nodiscard]] std::vector<Step> out_of_date() const;

  /// The arguments of the program that make the step's outputs in `output`, an empty folder, which
  /// is prepared for it. Throws core::Error, std::filesystem::filesystem_error; parts are merged
  /// only when all of them are up to date.
  [[nodiscard]] std::vector<std::string> prepare(Step step, const std::filesystem::path& output,
                                                 int threads) const;

  /// What the step's outputs are made from now, as a hash.
  [[nodiscard]] std::string fingerprint(Step step) const;

  /// Leaves a note in `output` of what it was made from (taken before the step ran) and how long it
  /// took.
  static void record(Step step, const std::filesystem::path& output, const std::string& made_from,
                     double seconds);

 private:
  [[nodiscard]] bool is_merged() const { return job_.parts > 1 && !part_; }
  /// The command that merges the parts.
  [[nodiscard]] std::vector<std::string> merge(const std::filesystem::path& output) const;
  /// The session that a step works on: the recording, or the links of the step before.
  [[nodiscard]] std::filesystem::path session_before(Step step) const;
  [[nodiscard]] std::string fingerprint(Step step, const std::string& recording) const;

  Job job_;
  std::filesystem::path folder_;
  std::optional<int> part_;  ///< from 1; none: the session
  std::vector<Step> steps_;  ///< of the session, whose replay alone is a part's
  int hold_out_;
  std::string format_;
};

}  // namespace sheen::app
