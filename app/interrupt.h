// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>

namespace sheen::app {

/// Ctrl-C or a termination request ended the work early. Unwinding removes unfinished outputs.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted; nothing existing was changed") {}
};

/// From now on SIGINT and SIGTERM only raise a flag that `throw_if_interrupted` reads.
void watch_for_interrupts();

/// While one exists, the first interrupt is no end but a wish to finish early:
/// `throw_if_interrupted` lets it pass, `wants_to_finish` tells of it.
class FinishOnInterrupt {
 public:
  FinishOnInterrupt();
  ~FinishOnInterrupt();
  FinishOnInterrupt(const FinishOnInterrupt&) = delete;
  FinishOnInterrupt& operator=(const FinishOnInterrupt&) = delete;
  FinishOnInterrupt(FinishOnInterrupt&&) = delete;
  FinishOnInterrupt& operator=(FinishOnInterrupt&&) = delete;

  /// From any thread.
  [[nodiscard]] static bool wants_to_finish();
};

/// Called between frames and between rows of long work, from any thread.
void throw_if_interrupted();

}  // namespace sheen::app
