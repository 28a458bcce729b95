// SPDX-License-Identifier: MIT
#include "app/preview/redraw_pace.h"

namespace sheen::app {
namespace {

constexpr std::size_t kRateRedraws = 30;
constexpr double kMemory = 0.8;     // weight of what went before a redraw
constexpr double kSlow_s = 0.027;   // a little sooner than 30 a second
constexpr double kQuick_s = 0.009;  // a third of it: four times the pixels still fit

}  // namespace

void RedrawPace::end(Clock::time_point now) {
  const double work_s = std::chrono::duration<double>(now - begin_).count();
  recent_s_ = ends_.empty() ? 0 : kMemory * recent_s_ + (1 - kMemory) * work_s;  // first: set-up
  if (recent_s_ > kSlow_s) is_slow_ = true;
  if (recent_s_ < kQuick_s) is_slow_ = false;
  ends_.push_back(now);
  if (ends_.size() > kRateRedraws) ends_.pop_front();
}

std::optional<double> RedrawPace::redraws_per_s() const {
  if (ends_.size() < 2) return std::nullopt;
  const std::chrono::duration<double> span = ends_.back() - ends_.front();
  return static_cast<double>(ends_.size() - 1) / span.count();
}

}  // namespace sheen::app
