// SPDX-License-Identifier: MIT
#include "app/pipeline/pipeline.h"

#include "app/interrupt.h"
#include "core/concurrency/bounded_queue.h"

#include <exception>
#include <thread>

namespace sheen::app {
namespace {

constexpr std::size_t kQueuedFrames = 3;  // evens out slow frames; each holds an image

/// Poses frames on a thread of its own, a few ahead of whoever takes them.
class PoseThread {
 public:
  explicit PoseThread(PoseStage& stage) : frames_(kQueuedFrames), thread_([&] { run(stage); }) {}
  ~PoseThread() { frames_.close(); }  // or the thread would wait for a reader that has left
  PoseThread(const PoseThread&) = delete;
  PoseThread& operator=(const PoseThread&) = delete;
  PoseThread(PoseThread&&) = delete;
  PoseThread& operator=(PoseThread&&) = delete;

  std::optional<TrackedFrame> next() {
    auto tracked = frames_.pop();
    if (!tracked && failure_) std::rethrow_exception(failure_);
    return tracked;
  }

 private:
  void run(PoseStage& stage) {
    try {
      while (auto tracked = stage.next()) {
        if (!frames_.push(std::move(*tracked))) break;
      }
    } catch (...) {
      failure_ = std::current_exception();  // read after the queue is closed
    }
    frames_.close();
  }

  core::BoundedQueue<TrackedFrame> frames_;
  std::exception_ptr failure_;
  std::jthread thread_;
};

template <typename Next>
core::StageTimer fit_all(const Next& next, ModelStage& model,
                         const std::function<void(const TrackedFrame&)>& on_frame) {
  core::StageTimer timer;
  timer.start();
  while (auto tracked = next()) {
    throw_if_interrupted();
    model.integrate(*tracked);
    timer.end_frame(tracked->times);
    on_frame(*tracked);
  }
  return timer;
}

}  // namespace

core::StageTimer run_pipeline(PoseStage& poses, ModelStage& model, bool overlap,
                              const std::function<void(const TrackedFrame&)>& on_frame) {
  if (!overlap) return fit_all([&] { return poses.next(); }, model, on_frame);
  PoseThread ahead(poses);
  return fit_all([&] { return ahead.next(); }, model, on_frame);
}

}  // namespace sheen::app
