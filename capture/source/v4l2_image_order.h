// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

namespace sheen::capture {

/// Makes of a driver's counts and stamps ones that only grow, also over a new start of the driver.
class ImageOrder {
 public:
  struct Place {
    std::uint32_t sequence = 0;  ///< from 0, images that were lost included
    int lost = 0;                ///< between the previous image and this one
  };

  /// The driver starts counting anew; what is missing until then is not known.
  void restart();

  [[nodiscard]] Place place(std::uint32_t driver_sequence);

  /// Seconds on the monotonic clock, larger than every one before: the driver's stamp, or the
  /// present where that cannot be true.
  [[nodiscard]] double stamp_s(std::chrono::nanoseconds driver_stamp, std::chrono::nanoseconds now);

 private:
  std::optional<std::uint32_t> driver_sequence_;  ///< of the previous image
  std::uint32_t next_sequence_ = 0;
  std::chrono::nanoseconds last_stamp_{0};
};

}  // namespace sheen::capture
