// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/mat.hpp>

#include <vector>

namespace sheen::capture {

/// How likely a colour belongs to the object or to what is around it, counted from pixels of
/// either kind.
class ColourStatistics {
 public:
  ColourStatistics();

  void add(const cv::Vec3b& bgr, bool on_object);

  /// Turns the counts into probabilities; call once, after the last `add`.
  void finish();

  /// log(P(object) / P(surroundings)) of a colour for equal shares of both, within
  /// +-kMostEvidence, so that one odd pixel does not decide.
  [[nodiscard]] float evidence(const cv::Vec3b& bgr) const { return evidence_[bin(bgr)]; }

  static constexpr float kMostEvidence = 2.5F;

 private:
  static constexpr int kBits = 4;  ///< 16 levels per channel
  static std::size_t bin(const cv::Vec3b& bgr) {
    constexpr int shift = 8 - kBits;
    return static_cast<std::size_t>(((bgr[0] >> shift) << (2 * kBits)) |
                                    ((bgr[1] >> shift) << kBits) | (bgr[2] >> shift));
  }

  std::vector<float> object_, surroundings_, evidence_;
};

}  // namespace sheen::capture
