// SPDX-License-Identifier: MIT
#include "capture/source/v4l2_image_order.h"

#include <algorithm>

namespace sheen::capture {
namespace {

/// A larger step in the driver's count is a new start, not a loss: ten minutes at 60 a second.
constexpr std::uint32_t largest_step = 36000;

/// An image is handed over within this time after its exposure.
constexpr std::chrono::seconds oldest_stamp{5};

}  // namespace

void ImageOrder::restart() {
  driver_sequence_.reset();
}

ImageOrder::Place ImageOrder::place(std::uint32_t driver_sequence) {
  // Unsigned arithmetic: the driver's count may run over. Some drivers do not count at all.
  std::uint32_t step = driver_sequence_ ? driver_sequence - *driver_sequence_ : 1;
  if (step == 0 || step > largest_step) step = 1;
  driver_sequence_ = driver_sequence;

  const std::uint32_t lost = step - 1;
  const std::uint32_t sequence = next_sequence_ + lost;
  next_sequence_ = sequence + 1;
  return {sequence, static_cast<int>(lost)};
}

double ImageOrder::stamp_s(std::chrono::nanoseconds driver_stamp, std::chrono::nanoseconds now) {
  const bool credible =
      driver_stamp > last_stamp_ && driver_stamp <= now && driver_stamp > now - oldest_stamp;
  last_stamp_ = credible ? driver_stamp : std::max(now, last_stamp_ + std::chrono::nanoseconds(1));
  return std::chrono::duration<double>(last_stamp_).count();
}

}  // namespace sheen::capture
