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

  /// Whether all colours added are shades of grey.
  [[nodiscard]] bool is_grey() const { return is_grey_; }

  /// Turns the counts into probabilities; call once, after the last `add`.
  void finish();

  /// log(P(object) / P(surroundings)) of a colour for equal shares of both, within
  /// +-kMostEvidence, so that one odd pixel does not decide.
  [[nodiscard]] float evidence(const cv::Vec3b& bgr) const {
    return evidence_[is_grey_ ? fine_bin(bgr) : bin(bgr)];
  }

  static constexpr float kMostEvidence = 2.5F;

 private:
  static constexpr int kBits = 4;      ///< 16 levels per channel
  static constexpr int kGreyBits = 7;  ///< where brightness is all that tells
  static constexpr std::size_t kColours = std::size_t{1} << (3 * kBits);
  static constexpr std::size_t kBins = kColours + (std::size_t{1} << kGreyBits);
  static std::size_t bin(const cv::Vec3b& bgr) {
    constexpr int shift = 8 - kBits;
    return static_cast<std::size_t>(((bgr[0] >> shift) << (2 * kBits)) |
                                    ((bgr[1] >> shift) << kBits) | (bgr[2] >> shift));
  }
  /// Of its own for every shade of grey.
  static std::size_t fine_bin(const cv::Vec3b& bgr) {
    if (bgr[0] != bgr[1] || bgr[1] != bgr[2]) return bin(bgr);
    return kColours + (std::size_t{bgr[0]} >> (8 - kGreyBits));
  }
  static void fold_greys(std::vector<float>& counts);

  bool is_grey_ = true;
  std::vector<float> object_, surroundings_, evidence_;
};

}  // namespace sheen::capture
