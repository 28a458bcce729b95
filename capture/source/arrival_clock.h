// SPDX-License-Identifier: MIT
#pragma once

#include <deque>

namespace sheen::capture {

/// Times of images that come over a network without a time of their own. A network delays some
/// images and hurries none: the clock runs on at the usual rate, early images set it back, late
/// ones pull it forward by little. No time is later than its image's arrival, and times increase.
class ArrivalClock {
 public:
  /// Time of the image that arrives now; `arrival_s` never decreases.
  double time_of(double arrival_s);

  /// Forgets the rate: after another connection.
  void restart() { arrivals_s_.clear(); }

 private:
  std::deque<double> arrivals_s_;  ///< of the last images
  double last_s_ = 0;
};

}  // namespace sheen::capture
