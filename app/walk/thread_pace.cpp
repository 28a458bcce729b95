// SPDX-License-Identifier: MIT
#include "app/walk/thread_pace.h"

#include "core/diagnostics/cpu_clock.h"

#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <utility>

namespace sheen::app {
namespace {

constexpr int kNice = 10;
constexpr double kRestPerWork = 1;
constexpr double kLeast_ms = 2;  // shorter work goes on until it adds up

}  // namespace

ThreadPace::ThreadPace(std::stop_token stop)
    : stop_(std::move(stop)), rested_at_ms_(core::own_cpu_ms()) {
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNice);  // of this thread only
}

void ThreadPace::rest() {
  if (stop_.stop_requested()) throw Stopped();
  const double worked_ms = core::own_cpu_ms() - rested_at_ms_;
  if (worked_ms < kLeast_ms) return;
  wait(1e-3 * kRestPerWork * worked_ms);
}

void ThreadPace::wait(double seconds) {
  std::unique_lock lock(mutex_);
  wake_.wait_for(lock, stop_, std::chrono::duration<double>(seconds), [] { return false; });
  rested_at_ms_ = core::own_cpu_ms();
  if (stop_.stop_requested()) throw Stopped();
}

}  // namespace sheen::app
