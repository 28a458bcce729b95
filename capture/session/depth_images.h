// SPDX-License-Identifier: MIT
#pragma once

#include "capture/session/session.h"
#include "capture/source/image_folder_source.h"

#include <opencv2/core/mat.hpp>

#include <filesystem>

namespace sheen::capture {

/// The depth images of a session (docs/session-format.md), one for each frame, registered to the
/// colour camera.
class DepthImages {
 public:
  /// Those of `session`, which has some. Throws core::Error (bad_input): none, a gap in the
  /// numbers.
  explicit DepthImages(const Session& session);

  /// How far every pixel of a frame's image, which has the camera's size, is along the optical
  /// axis: CV_32FC1, metres, 0 where that is not known. An image of another size is read at the
  /// nearest pixel, because between two surfaces there is none. Throws core::Error (bad_input): no
  /// depth image for this frame, no PNG of 16 bits grey, damaged, another aspect ratio than the
  /// frames.
  [[nodiscard]] cv::Mat read(int frame_index) const;

 private:
  std::filesystem::path folder_;
  NumberedName name_;
  NumberedImages numbers_;
  double unit_m_;
  cv::Size frame_size_;
};

}  // namespace sheen::capture
