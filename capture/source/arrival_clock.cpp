// SPDX-License-Identifier: MIT
#include "capture/source/arrival_clock.h"

#include <algorithm>

namespace sheen::capture {
namespace {

constexpr std::size_t kMostArrivals = 64;  // two seconds at the usual rate
constexpr std::size_t kFewArrivals = 8;    // fewer tell no rate
constexpr double kPull = 0.02;             // of the lateness, for clocks that drift
constexpr double kGap = 3;                 // periods without an image: a pause, not a delay
constexpr double kLeastStep_s = 1e-6;

}  // namespace

double ArrivalClock::time_of(double arrival_s) {
  double time_s = arrival_s;
  const std::size_t count = arrivals_s_.size();
  if (count >= kFewArrivals) {
    const double period_s =
        (arrivals_s_.back() - arrivals_s_.front()) / static_cast<double>(count - 1);
    const double expected_s = last_s_ + period_s;
    const double late_s = arrival_s - expected_s;
    if (late_s > 0 && late_s < kGap * period_s) time_s = expected_s + kPull * late_s;
  }
  arrivals_s_.push_back(arrival_s);
  if (arrivals_s_.size() > kMostArrivals) arrivals_s_.pop_front();
  if (count > 0) time_s = std::max(time_s, last_s_ + kLeastStep_s);
  last_s_ = time_s;
  return time_s;
}

}  // namespace sheen::capture
