// SPDX-License-Identifier: MIT
#include "app/preview/run_preview.h"

#include "app/interrupt.h"
#include "app/preview/live_session.h"
#include "app/preview/preview_window.h"
#include "app/preview/walk_window.h"

#include <atomic>
#include <exception>
#include <thread>

namespace sheen::app {
namespace {

constexpr double kLongestWait_s = 0.5;  // so that an interruption is noticed
constexpr double kWalkWait_s = 0.05;    // images come unasked

/// The session goes on by itself, however the window ends.
class Watch {
 public:
  explicit Watch(LiveSession& live) : live_(live) {}
  ~Watch() { live_.close(); }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;
  Watch(Watch&&) = delete;
  Watch& operator=(Watch&&) = delete;

 private:
  LiveSession& live_;
};

/// Work on another thread than the window's.
class Work {
 public:
  void run(const std::function<void()>& work) {
    try {
      work();
    } catch (...) {
      failure_ = std::current_exception();
      has_failed_ = true;
    }
    is_done_ = true;
  }
  [[nodiscard]] bool has_failed() const { return has_failed_; }
  [[nodiscard]] bool is_done() const { return is_done_; }
  /// Once its thread has ended.
  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  std::exception_ptr failure_;
  std::atomic<bool> has_failed_{false};
  std::atomic<bool> is_done_{false};
};

}  // namespace

void check_display() {
  Window::check_display();
}

void run_viewer(const PreviewSubject& subject) {
  PreviewWindow window(subject);
  while (window.redraw(kLongestWait_s)) throw_if_interrupted();
}

void run_preview(const PreviewSubject& subject, const std::function<void()>& work,
                 const std::function<void()>& on_closed) {
  Work done;
  {
    std::jthread worker;  // outlives the window, which would stand there frozen otherwise
    PreviewWindow window(subject);
    worker = std::jthread([&] { done.run(work); });
    const Watch watch(*subject.live);
    const auto goes_on = [&] {
      return !done.has_failed() && !(done.is_done() && FinishOnInterrupt::wants_to_finish());
    };
    while (goes_on() && window.redraw(kLongestWait_s)) throw_if_interrupted();
    if (on_closed) on_closed();
  }
  done.rethrow();
}

void run_walk(const WalkSubject& subject, const std::function<void()>& work,
              const std::function<void()>& on_closed) {
  Work done;
  {
    std::jthread worker;
    WalkWindow window(subject);
    worker = std::jthread([&] { done.run(work); });
    while (!done.is_done() && window.redraw(kWalkWait_s)) throw_if_interrupted();
    on_closed();
  }
  done.rethrow();
}

}  // namespace sheen::app
