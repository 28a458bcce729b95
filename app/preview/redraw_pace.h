// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <deque>
#include <optional>

namespace sheen::app {

/// How often the window is redrawn, and whether that costs more time than a fluent picture has.
class RedrawPace {
 public:
  using Clock = std::chrono::steady_clock;

  /// Between them a redraw is at work; waiting for something to happen is not work.
  void begin(Clock::time_point now = Clock::now()) { begin_ = now; }
  void end(Clock::time_point now = Clock::now());

  /// Of the last second or so; nothing before the second redraw.
  [[nodiscard]] std::optional<double> redraws_per_s() const;
  /// Recent redraws took so long that 30 a second are in danger. Remains so until they could be
  /// done with far more to draw, so that the picture does not flicker between two qualities.
  [[nodiscard]] bool is_slow() const { return is_slow_; }

 private:
  Clock::time_point begin_{};
  std::deque<Clock::time_point> ends_;
  double recent_s_ = 0;  ///< work of a redraw, averaged over the last few
  bool is_slow_ = false;
};

}  // namespace sheen::app
