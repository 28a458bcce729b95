// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/guidance/view_utility.h"

#include <string_view>
#include <vector>

namespace sheen::fitting::guidance {

/// What is to be thought of a frame before it is integrated. New directions alone are never a
/// fault: only directions seen before are held against a frame.
enum class FrameVerdict {
  fine,
  exposure_step,  ///< brighter or darker than what was seen, and agrees once that is taken out
  mismatch        ///< disagrees in another way: wrong pose, moved object, something in between
};
std::string_view name_of(FrameVerdict verdict);

/// Tells frames that contradict the model from those that are new to it, by comparing a frame's
/// normalised residual with what recent frames showed.
class FrameGate {
 public:
  /// Judges a frame. Its normalised residual becomes part of what is usual when it is fine.
  FrameVerdict judge(const FrameScore& score);

 private:
  [[nodiscard]] double usual_normalised_residual() const;

  std::vector<double> recent_;  ///< normalised residuals of fine frames, the last few in a ring
  std::size_t next_ = 0;
};

}  // namespace sheen::fitting::guidance
