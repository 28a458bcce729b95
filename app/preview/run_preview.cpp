// SPDX-License-Identifier: MIT
#include "app/preview/run_preview.h"

#include "app/interrupt.h"
#include "app/preview/live_session.h"
#include "app/preview/preview_window.h"

#include <atomic>
#include <exception>
#include <thread>

namespace sheen::app {
namespace {

constexpr double kLongestWait_s = 0.5;  // so that an interruption is noticed

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
  std::exception_ptr failure;
  {
    std::atomic<bool> failed{false};
    std::atomic<bool> done{false};
    std::jthread worker;  // outlives the window, which would stand there frozen otherwise
    PreviewWindow window(subject);
    worker = std::jthread([&] {
      try {
        work();
      } catch (...) {
        failure = std::current_exception();
        failed = true;
      }
      done = true;
    });
    const Watch watch(*subject.live);
    const auto goes_on = [&] { return !failed && !(done && FinishOnInterrupt::wants_to_finish()); };
    while (goes_on() && window.redraw(kLongestWait_s)) throw_if_interrupted();
    if (on_closed) on_closed();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace sheen::app
