// SPDX-License-Identifier: MIT
#pragma once

#include "core/concurrency/worker_pool.h"

#include <algorithm>
#include <cstddef>
#include <exception>
#include <mutex>

namespace sheen::core {

/// Calls `body(begin, end)` on disjoint ranges that cover [0, count), on up to `threads` threads of
/// the shared WorkerPool, the calling one included; with one thread everything runs inline. The
/// ranges follow from the arguments alone. The first exception of a body is rethrown here
/// after all have ended. Bodies must write to disjoint places: then the result does not depend on
/// `threads`. Bodies may call parallel_for themselves. The CPU time of all threads counts as the
/// caller's (`own_cpu_ms`). Below `min_range` another thread costs more than it saves.
template <typename Body>
void parallel_for(std::size_t count, int threads, const Body& body, std::size_t min_range = 256) {
  const std::size_t useful = std::max<std::size_t>(1, count / min_range);
  const std::size_t parts = std::min<std::size_t>(std::max(1, threads), useful);
  if (parts == 1) {
    if (count > 0) body(std::size_t{0}, count);
    return;
  }
  std::mutex mutex;
  std::exception_ptr failure;
  const auto run_part = [&](std::size_t part) {
    try {
      body(part * count / parts, (part + 1) * count / parts);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
    }
  };
  using RunPart = decltype(run_part);
  WorkerPool::shared().run(
      parts, [](const void* job, std::size_t part) { (*static_cast<const RunPart*>(job))(part); },
      &run_part);
  if (failure) std::rethrow_exception(failure);
}

}  // namespace sheen::core
