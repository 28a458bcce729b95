// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/guidance/view_utility.h"

#include <vector>

namespace sheen::fitting::guidance {

/// How well frames were predicted before they were integrated, and how much of the object had been
/// seen: the live measure of quality, and the sign to stop.
class QualityCurve {
 public:
  /// A frame was integrated; `coverage` in [0, 1] after it.
  void add(const FrameScore& score, double coverage);

  /// PSNR of every frame's prediction, dB, smoothed over a second or so.
  [[nodiscard]] const std::vector<float>& psnr_db() const { return psnr_db_; }

  /// Whether going on as before brings little: over the last three seconds at 30 frames a second
  /// neither the quality nor the coverage has risen noticeably.
  [[nodiscard]] bool is_flat() const;

 private:
  std::vector<float> psnr_db_;
  std::vector<float> coverage_;
};

}  // namespace sheen::fitting::guidance
