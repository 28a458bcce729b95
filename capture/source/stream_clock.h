// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

namespace sheen::capture {

/// Brings the stamps that a stream states, of a clock that begins anywhere and drifts, to the
/// steady clock of this machine. A network delays some images and hurries none: the smallest
/// difference between arrival and stamp so far is the one without a delay. Towards a smaller one
/// the times run slower by a tenth, so that spacings stay what they are; for clocks that drift it
/// grows by little.
class StreamClock {
 public:
  /// Takes note of an image that arrives; `arrival_s` never decreases.
  void note(double stamp_s, double arrival_s);

  /// Time of an image that was noted. Images in another order than that of their stamps keep the
  /// order of their stamps.
  [[nodiscard]] double time_of(double stamp_s) const { return stamp_s + difference_s_; }

  /// Forgets the difference: after another connection. Later times are none before those until
  /// now.
  void restart();

 private:
  std::optional<double> newest_s_;  ///< largest stamp since the last restart
  double difference_s_ = 0;         ///< of the times given
  double least_s_ = 0;              ///< difference without a delay
  std::optional<double> before_s_;  ///< latest time before the last restart
};

}  // namespace sheen::capture
