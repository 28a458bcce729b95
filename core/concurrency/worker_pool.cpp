// SPDX-License-Identifier: MIT
#include "core/concurrency/worker_pool.h"

#include "core/diagnostics/cpu_clock.h"

#include <algorithm>

namespace sheen::core {

WorkerPool::~WorkerPool() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  has_calls_.notify_all();
  workers_.clear();  // joins
}

WorkerPool& WorkerPool::shared() {
  static WorkerPool pool;
  return pool;
}

void WorkerPool::run(std::size_t parts, Part run_part, const void* job) {
  Call call{.parts = parts, .run_part = run_part, .job = job};
  std::unique_lock lock(mutex_);
  while (workers_.size() + 1 < parts) workers_.emplace_back([this] { work(); });
  calls_.push_back(&call);
  for (std::size_t other = 1; other < parts; ++other) has_calls_.notify_one();
  while (call.next < call.parts) {
    const std::size_t part = take_part(call);
    lock.unlock();
    run_part(job, part);
    lock.lock();
    --call.running;
  }
  call.ended.wait(lock, [&call] { return call.running == 0; });
  credit_cpu_ms(call.workers_cpu_ms);
}

void WorkerPool::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    has_calls_.wait(lock, [this] { return stopping_ || !calls_.empty(); });
    if (calls_.empty()) return;
    Call& call = *calls_.front();
    const std::size_t part = take_part(call);
    lock.unlock();
    const double begin_cpu_ms = own_cpu_ms();
    call.run_part(call.job, part);
    const double cpu_ms = own_cpu_ms() - begin_cpu_ms;
    lock.lock();
    // The caller cannot leave before it gets the lock, so its Call still stands.
    call.workers_cpu_ms += cpu_ms;
    if (--call.running == 0) call.ended.notify_one();
  }
}

std::size_t WorkerPool::take_part(Call& call) {
  const std::size_t part = call.next++;
  if (call.next == call.parts) calls_.erase(std::find(calls_.begin(), calls_.end(), &call));
  ++call.running;
  return part;
}

}  // namespace sheen::core
