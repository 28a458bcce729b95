// SPDX-License-Identifier: MIT
#include "app/interrupt.h"

#include <atomic>
#include <csignal>

namespace sheen::app {
namespace {

std::atomic<bool> interrupted{false};
std::atomic<bool> only_finishes{false};
static_assert(std::atomic<bool>::is_always_lock_free, "the flag is set by a signal handler");

void raise_flag(int signal) {
  interrupted = true;
  // A second Ctrl-C means it: back to the default, which ends the program at once.
  std::signal(signal, SIG_DFL);
}

}  // namespace

void watch_for_interrupts() {
  std::signal(SIGINT, raise_flag);
  std::signal(SIGTERM, raise_flag);
}

void throw_if_interrupted() {
  if (interrupted && !only_finishes) throw Interrupted();
}

FinishOnInterrupt::FinishOnInterrupt() {
  only_finishes = true;
}

FinishOnInterrupt::~FinishOnInterrupt() {
  interrupted = false;  // it was obeyed
  only_finishes = false;
}

bool FinishOnInterrupt::wants_to_finish() {
  return interrupted;
}

}  // namespace sheen::app
