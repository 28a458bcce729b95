// SPDX-License-Identifier: MIT
#pragma once

#include "app/commands/command_context.h"
#include "pipeline/progress_sink.h"

#include <optional>
#include <string>

namespace sheen::app {

/// Shows the pipeline's progress on stderr and ends its work when the user interrupts.
class TerminalSink final : public pipeline::ProgressSink {
 public:
  explicit TerminalSink(const CommandContext& context) : context_(context) {}

  void progress(const pipeline::StepProgress& step) override;
  void note(const std::string& line) override { context_.note("note: " + line); }

 private:
  const CommandContext& context_;
  std::string step_;
  std::optional<Progress> shown_;
};

}  // namespace sheen::app
