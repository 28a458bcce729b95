// SPDX-License-Identifier: MIT
#include "pipeline/frame_loop.h"

#include "core/concurrency/bounded_queue.h"

#include <exception>
#include <thread>

namespace sheen::pipeline {
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

  /// Filled by `thread_`. What waits when the stage ends or fails is delivered, then the failure is
  /// thrown. Whoever leaves before gives up what waits; the thread ends with the frame it is
  /// posing, for which a camera may keep it waiting as long as that has patience
  /// (V4l2CameraOptions).
  core::BoundedQueue<TrackedFrame> frames_;
  std::exception_ptr failure_;
  std::jthread thread_;
};

template <typename Next>
core::StageTimer take_all(const Next& next, const std::function<void(TrackedFrame&)>& take) {
  core::StageTimer timer;
  timer.start();
  while (auto tracked = next()) {
    take(*tracked);
    timer.end_frame(tracked->times);
  }
  return timer;
}

}  // namespace

core::StageTimer for_each_frame(PoseStage& poses, bool overlap,
                                const std::function<void(TrackedFrame&)>& take) {
  if (!overlap) return take_all([&] { return poses.next(); }, take);
  PoseThread ahead(poses);
  return take_all([&] { return ahead.next(); }, take);
}

}  // namespace sheen::pipeline
