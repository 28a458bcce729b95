// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/mat.hpp>

#include <filesystem>
#include <string>

namespace sheen::capture {

/// Whether pictures of 16 bits hold numbers of fewer: cameras of 10, 12 or 14 bits are often
/// written so, and read as 16 bits they are dark. One picture may be dark; many that never pass the
/// most of 12 bits are black at 8 bits, whatever they were meant to be.
class NumberDepth {
 public:
  /// `image` has 16 bits a channel.
  void look_at(const cv::Mat& image);

  /// What is doubtful, to be said; empty where nothing is.
  [[nodiscard]] std::string doubt() const;

  /// Throws core::Error (bad_input) where enough pictures were seen and all of them are black.
  void check(const std::filesystem::path& subject) const;

 private:
  int pictures_ = 0;
  int largest_ = 0;
};

}  // namespace sheen::capture
