// SPDX-License-Identifier: MIT
#pragma once

#include "core/diagnostics/cpu_clock.h"

#include <algorithm>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace sheen::core {

/// Calls `body(begin, end)` on disjoint ranges that cover [0, count), on up to `threads` threads,
/// the calling one included; with one thread everything runs inline. The first exception of a
/// body is rethrown here after all have ended. Bodies must write to disjoint places: then the
/// result does not depend on `threads`. The CPU time of all threads counts as the caller's
/// (`own_cpu_ms`).
template <typename Body>
void parallel_for(std::size_t count, int threads, const Body& body) {
  constexpr std::size_t min_range = 256;  // below this a thread costs more than it saves
  const std::size_t useful = std::max<std::size_t>(1, count / min_range);
  const std::size_t parts = std::min<std::size_t>(std::max(1, threads), useful);
  if (parts == 1) {
    if (count > 0) body(std::size_t{0}, count);
    return;
  }
  std::mutex mutex;
  std::exception_ptr failure;
  std::vector<double> part_cpu_ms(parts);
  const auto run_part = [&](std::size_t part) {
    try {
      body(part * count / parts, (part + 1) * count / parts);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> workers;
    workers.reserve(parts - 1);
    for (std::size_t part = 1; part < parts; ++part) {
      workers.emplace_back([&, part] {
        const double begin_cpu_ms = own_cpu_ms();
        run_part(part);
        part_cpu_ms[part] = own_cpu_ms() - begin_cpu_ms;
      });
    }
    run_part(0);
  }
  for (const double ms : part_cpu_ms) credit_cpu_ms(ms);
  if (failure) std::rethrow_exception(failure);
}

}  // namespace sheen::core
