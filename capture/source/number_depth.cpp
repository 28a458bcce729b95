// SPDX-License-Identifier: MIT
#include "capture/source/number_depth.h"

#include "core/diagnostics/error.h"

#include <fmt/format.h>
#include <opencv2/core.hpp>

#include <algorithm>

namespace sheen::capture {
namespace {

constexpr int kMostOf12Bits = 4095;  // 15 of 255: no picture is left
constexpr int kMostOf14Bits = 16383;
constexpr int kManyPictures = 8;

/// The usual number: 8, 10, 12, 14.
int bits_for(int largest) {
  int bits = 8;
  while (largest >= 1 << bits) bits += 2;
  return bits;
}

std::string fault_text(int largest) {
  return fmt::format(
      "of 16 bits hold no number above {}, as of cameras of {} bits: read so they are dark, "
      "at most {} of 255",
      largest, bits_for(largest), largest / 257);
}

std::string remedy_text(int largest) {
  return fmt::format(
      "multiply them by {} first (ImageMagick: mogrify -evaluate multiply {}), or give 8 bits",
      1 << (16 - bits_for(largest)), 1 << (16 - bits_for(largest)));
}

}  // namespace

void NumberDepth::look_at(const cv::Mat& image) {
  double largest = 0;
  cv::minMaxLoc(image.reshape(1), nullptr, &largest);
  largest_ = std::max(largest_, static_cast<int>(largest));
  ++pictures_;
}

std::string NumberDepth::doubt() const {
  if (pictures_ == 0 || largest_ > kMostOf14Bits) return {};
  return "its images " + fault_text(largest_) + "; if they are not meant so, " +
         remedy_text(largest_);
}

void NumberDepth::check(const std::filesystem::path& subject) const {
  if (pictures_ < kManyPictures || largest_ > kMostOf12Bits) return;
  throw core::bad_input(subject, fmt::format("its {} images {}", pictures_, fault_text(largest_)),
                        remedy_text(largest_));
}

}  // namespace sheen::capture
