// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <thread>
#include <vector>

namespace sheen::core {

/// Threads that stay between calls, because a stage of a millisecond is over before a new thread
/// has begun. They sleep on a condition variable while there is nothing to do. All members may be
/// called from any thread, from inside a running part too.
class WorkerPool {
 public:
  /// One part of a job; must not throw.
  using Part = void (*)(const void* job, std::size_t part);

  WorkerPool() = default;
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;
  WorkerPool(WorkerPool&&) = delete;
  WorkerPool& operator=(WorkerPool&&) = delete;

  /// The pool of the whole program.
  static WorkerPool& shared();

  /// Calls `run_part(job, part)` for every part in [0, parts) and returns when all have ended. The
  /// caller takes parts itself, so a call ends even when every worker is busy elsewhere; what the
  /// workers do is credited to its `own_cpu_ms`. Starts workers until there are parts - 1 of them.
  void run(std::size_t parts, Part run_part, const void* job);

 private:
  /// A call of `run` under way; lives on its caller's stack.
  struct Call {
    std::size_t parts;
    Part run_part;
    const void* job;
    std::size_t next = 0;  ///< first part that nobody has taken
    std::size_t running = 0;
    double workers_cpu_ms = 0;
    std::condition_variable ended{};
  };

  void work();
  std::size_t take_part(Call& call);

  std::mutex mutex_;  ///< guards everything below and every Call
  std::condition_variable has_calls_;
  std::deque<Call*> calls_;  ///< those with parts nobody has taken
  bool stopping_ = false;
  std::vector<std::jthread> workers_;
};

}  // namespace sheen::core
