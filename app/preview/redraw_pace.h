// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>

namespace sheen::app {

/// Whether redraws take more time than a fluent image has.
class RedrawPace {
 public:
  using Clock = std::chrono::steady_clock;

  /// Between them a redraw is at work; waiting for something to happen is not work.
  void begin(Clock::time_point now = Clock::now()) { begin_ = now; }
  void end(Clock::time_point now = Clock::now());

  /// Wall time of a redraw, averaged over the last few.
  [[nodiscard]] double work_ms() const { return 1e3 * recent_s_; }
  /// Recent redraws took so long that 30 a second are in danger. Remains so until they could be
  /// done with far more to draw, so that the image does not flicker between two qualities.
  [[nodiscard]] bool is_slow() const { return is_slow_; }

 private:
  Clock::time_point begin_{};
  bool is_set_up_ = false;  ///< the first redraw, which makes everything, is over
  double recent_s_ = 0;
  bool is_slow_ = false;
};

}  // namespace sheen::app
