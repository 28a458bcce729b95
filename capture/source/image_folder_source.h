// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/frame_range.h"
#include "capture/source/frame_source.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace sheen::capture {

/// A file name with one number in it, written as printf does: `images/%04d.png`.
class NumberedName {
 public:
  /// No value unless the file name (not its folders) holds exactly one `%d` or `%0Nd` and no other
  /// `%`: the pattern comes from a file and must never reach printf.
  static std::optional<NumberedName> parse(const std::string& pattern);

  [[nodiscard]] std::string at(int number) const;
  /// The number in a file name of this form (without folder), if it is one.
  [[nodiscard]] std::optional<int> number_in(const std::string& file_name) const;
  [[nodiscard]] const std::string& folder() const { return folder_; }

 private:
  std::string folder_, prefix_, suffix_;
  std::size_t digits_ = 0;
};

/// Numbers of the images of a folder.
struct NumberedImages {
  int first = 0;  ///< 0 or 1
  int count = 0;
};

/// Those that the folder holds. Throws core::Error (bad_input): a kind that is not read, no image,
/// a gap in the numbers.
NumberedImages find_images(const std::filesystem::path& session_folder, const NumberedName& name);

/// Images of a folder as frames, in the order of their numbers; the first number is 0 or 1. Times
/// are index / `fps`, or one second per image. Throws core::Error (bad_input): no image, a gap
/// in the numbers, an image that cannot be read or has another size (the first one is read before
/// this returns).
std::unique_ptr<FrameSource> open_image_folder(const std::filesystem::path& session_folder,
                                               const std::string& pattern, const ImageSize& size,
                                               const FrameRange& range, std::optional<double> fps);

}  // namespace sheen::capture
