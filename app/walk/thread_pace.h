// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <mutex>
#include <stop_token>

namespace sheen::app {

/// The work behind a window must leave the cores to a recording: its thread yields to all others
/// (nice 10) and rests as long as it has worked, so it takes half a core at most.
class ThreadPace {
 public:
  /// Thrown by `rest` and `wait` to whoever is asked to stop.
  struct Stopped {};

  /// On the thread that is paced; those that it starts yield like it.
  explicit ThreadPace(std::stop_token stop);

  /// Between two pieces of work. Throws Stopped.
  void rest();
  /// Looks again after a while, at nothing's cost. Throws Stopped.
  void wait(double seconds);

 private:
  std::stop_token stop_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  double rested_at_ms_;  ///< CPU time of the thread
};

}  // namespace sheen::app
