// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

namespace sheen::capture {

/// The frame rate that session.json states, where it states one: it wins over a video's own times.
/// Remembers how far the two disagree.
class StatedRate {
 public:
  explicit StatedRate(std::optional<double> fps) : fps_(fps) {}

  /// Time of a frame by the stated rate, and from frame to frame.
  [[nodiscard]] std::optional<double> time_s(int index) const;
  [[nodiscard]] std::optional<double> spacing_s() const;

  /// Takes note of a frame's own time.
  void compare(int index, double own_time_s);

  /// What to say when the two differ by more than half a frame somewhere; nothing else.
  [[nodiscard]] std::optional<std::string> disagreement() const;

 private:
  std::optional<double> fps_;
  double largest_s_ = 0;
  int at_frame_ = 0;
};

}  // namespace sheen::capture
