// SPDX-License-Identifier: MIT
#include "capture/source/stated_rate.h"

#include <fmt/format.h>

#include <cmath>

namespace sheen::capture {

std::optional<double> StatedRate::time_s(int index) const {
  return fps_ ? std::optional(index / *fps_) : std::nullopt;
}

std::optional<double> StatedRate::spacing_s() const {
  return fps_ ? std::optional(1 / *fps_) : std::nullopt;
}

void StatedRate::compare(int index, double own_time_s) {
  if (!fps_) return;
  const double difference_s = std::abs(index / *fps_ - own_time_s);
  if (difference_s <= largest_s_) return;
  largest_s_ = difference_s;
  at_frame_ = index;
}

std::optional<std::string> StatedRate::disagreement() const {
  if (!fps_ || largest_s_ <= 0.5 / *fps_) return std::nullopt;
  return fmt::format(
      "the {:.6g} frames a second of session.json win, but its own times differ from them by "
      "{:.3g} "
      "s at frame {}; leave \"fps\" out of session.json to take the video's",
      *fps_, largest_s_, at_frame_);
}

}  // namespace sheen::capture
