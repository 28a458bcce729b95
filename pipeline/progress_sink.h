// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace sheen::pipeline {

/// How far a step of long work has come.
struct StepProgress {
  std::string_view step;    ///< "fitting"
  int done = 0;             ///< frames, as a rule
  int total = 0;            ///< 0: not known
  std::string detail = {};  ///< "112 posed"
};

/// Hears of long work. Whatever a member throws ends the work and comes out of the call that does
/// it: that is how work is cancelled.
class ProgressSink {
 public:
  virtual ~ProgressSink() = default;

  /// After every frame or other small part, on the thread that called.
  virtual void progress(const StepProgress& /*step*/) {}

  /// One line that the user should see: something was doubtful or left undone.
  virtual void note(const std::string& /*line*/) {}
};

}  // namespace sheen::pipeline
