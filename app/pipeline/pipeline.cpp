// SPDX-License-Identifier: MIT
#include "app/pipeline/pipeline.h"

#include "app/interrupt.h"
#include "core/concurrency/bounded_queue.h"

#include <exception>
#include <thread>

namespace sheen::app {
namespace {

constexpr std::size_t kQueuedReports = 4;

void run_sequentially(Producer& producer, const std::function<void(const FrameReport&)>& on_frame) {
  while (const auto report = producer.step()) {
    throw_if_interrupted();
    on_frame(*report);
  }
}

void run_on_own_thread(Producer& producer,
                       const std::function<void(const FrameReport&)>& on_frame) {
  core::BoundedQueue<FrameReport> reports(kQueuedReports);
  std::exception_ptr failure;
  std::jthread thread([&] {
    try {
      while (auto report = producer.step()) {
        throw_if_interrupted();
        if (!reports.push(std::move(*report))) break;
      }
    } catch (...) {
      failure = std::current_exception();
    }
    reports.close();
  });
  try {
    while (const auto report = reports.pop()) on_frame(*report);
  } catch (...) {
    reports.close();  // or the producer would wait for a reader that has left
    throw;
  }
  thread.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace

void run_pipeline(Producer& producer, bool threaded,
                  const std::function<void(const FrameReport&)>& on_frame) {
  if (threaded) {
    run_on_own_thread(producer, on_frame);
  } else {
    run_sequentially(producer, on_frame);
  }
}

}  // namespace sheen::app
