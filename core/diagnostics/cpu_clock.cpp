// SPDX-License-Identifier: MIT
#include "core/diagnostics/cpu_clock.h"

#include <time.h>

namespace sheen::core {
namespace {

thread_local double credited_ms = 0;

double read_ms(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

}  // namespace

double process_cpu_ms() {
  return read_ms(CLOCK_PROCESS_CPUTIME_ID);
}

double own_cpu_ms() {
  return read_ms(CLOCK_THREAD_CPUTIME_ID) + credited_ms;
}

void credit_cpu_ms(double ms) {
  credited_ms += ms;
}

}  // namespace sheen::core
