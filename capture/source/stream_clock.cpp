// SPDX-License-Identifier: MIT
#include "capture/source/stream_clock.h"

#include <algorithm>
#include <cmath>

namespace sheen::capture {
namespace {

constexpr double kJump_s = 10;    // no delay: the sender has set its clock
constexpr double kDrift = 2e-4;   // quartz clocks differ by less
constexpr double kSlowing = 0.1;  // pictures that are stored out of order stay in their order
constexpr double kStepAfterCut_s = 1e-3;

}  // namespace

void StreamClock::note(double stamp_s, double arrival_s) {
  const double difference_s = arrival_s - stamp_s;
  if (newest_s_ && std::abs(difference_s - least_s_) > kJump_s) restart();
  if (!newest_s_) {
    newest_s_ = stamp_s;
    least_s_ = difference_s;
    difference_s_ = difference_s;
    if (before_s_) difference_s_ = std::max(difference_s_, *before_s_ + kStepAfterCut_s - stamp_s);
    return;
  }
  const double progress_s = std::max(0.0, stamp_s - *newest_s_);
  newest_s_ = *newest_s_ + progress_s;
  least_s_ = std::min(least_s_ + kDrift * progress_s, difference_s);
  difference_s_ = std::max(least_s_, difference_s_ - kSlowing * progress_s);
}

void StreamClock::restart() {
  if (newest_s_) before_s_ = std::max(before_s_.value_or(0), time_of(*newest_s_));
  newest_s_.reset();
}

}  // namespace sheen::capture
