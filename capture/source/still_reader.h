// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/colour_profile.h"
#include "capture/source/frame_range.h"
#include "capture/source/image_facts.h"
#include "capture/source/number_depth.h"

#include <opencv2/core/mat.hpp>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace sheen::capture {

/// Reads photographs one after the other: stored pixels (EXIF's orientation is obeyed only where
/// the camera file is for the turned images), colours in sRGB whatever the profile, 8 bits.
class StillReader {
 public:
  /// The picture, CV_8UC3, BGR. `expected` is the camera's size; where it is missing the first
  /// picture's stored size binds the others. Throws core::Error (bad_input): no such file, a kind
  /// that is not read (by its name), damaged or cut short, another size.
  cv::Mat read(const std::filesystem::path& path, std::optional<ImageSize> expected);

  /// What was converted or is doubtful so far; each cause once, with the first file and how many.
  [[nodiscard]] std::vector<std::string> notes() const;

  /// After the last picture: throws core::Error (bad_input) where all of them together show that
  /// they are not what their headers say. `subject` is their folder.
  void check_all(const std::filesystem::path& subject) const { depth_.check(subject); }

 private:
  struct Cause {
    std::string first;  ///< path
    int count = 0;
  };
  void note(const std::filesystem::path& path, const std::string& cause);
  void take_depth(const std::filesystem::path& path, cv::Mat& image);
  void convert_colours(const std::filesystem::path& path, const ImageFacts& facts, cv::Mat& bgr);

  std::optional<ImageSize> bound_;                                ///< stored size of the first
  std::map<std::string, std::optional<ColourProfile>> profiles_;  ///< by their bytes
  std::optional<ColourProfile> adobe_rgb_;
  NumberDepth depth_;
  std::filesystem::path first_deep_;  ///< of 16 bits
  std::map<std::string, Cause> causes_;
};

}  // namespace sheen::capture
