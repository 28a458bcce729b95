// SPDX-License-Identifier: MIT
#include "app/terminal_sink.h"

#include "app/interrupt.h"

namespace sheen::app {

void TerminalSink::progress(const pipeline::StepProgress& step) {
  throw_if_interrupted();
  if (!shown_ || step_ != step.step) {
    shown_.reset();
    step_ = step.step;
    shown_.emplace(step_, step.total, context_.quiet);
  }
  shown_->show(step.done, step.detail);
}

}  // namespace sheen::app
