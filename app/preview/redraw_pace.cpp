// SPDX-License-Identifier: MIT
#include "app/preview/redraw_pace.h"

#include <utility>

namespace sheen::app {
namespace {

constexpr double kMemory = 0.8;     // weight of what went before a redraw
constexpr double kSlow_s = 0.027;   // a little sooner than 30 a second
constexpr double kQuick_s = 0.009;  // a third of it: four times the pixels still fit

}  // namespace

void RedrawPace::end(Clock::time_point now) {
  const double work_s = std::chrono::duration<double>(now - begin_).count();
  recent_s_ = std::exchange(is_set_up_, true) ? kMemory * recent_s_ + (1 - kMemory) * work_s : 0;
  if (recent_s_ > kSlow_s) is_slow_ = true;
  if (recent_s_ < kQuick_s) is_slow_ = false;
}

}  // namespace sheen::app
