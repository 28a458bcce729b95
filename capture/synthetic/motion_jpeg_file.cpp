// SPDX-License-Identifier: MIT
#include "capture/synthetic/motion_jpeg_file.h"

#include "core/diagnostics/error.h"

#include <opencv2/imgcodecs.hpp>

#include <cassert>
#include <system_error>
#include <utility>

namespace sheen::capture::synthetic {

MotionJpegFile::MotionJpegFile(std::filesystem::path path, cv::Size size_px, int fps, int quality)
    : path_(std::move(path)),
      size_px_(size_px),
      quality_(quality),
      file_(path_, {size_px.width, size_px.height}, fps) {}

void MotionJpegFile::append(const cv::Mat& image) {
  assert(image.type() == CV_8UC3 && image.size() == size_px_);
  cv::imencode(".jpg", image, jpeg_, {cv::IMWRITE_JPEG_QUALITY, quality_});
  check(file_.append(jpeg_));
}

void MotionJpegFile::close() {
  check(file_.close());
}

void MotionJpegFile::check(int fault) const {
  if (fault == 0) return;
  throw core::Error(core::Error::Kind::run_failed, path_,
                    "cannot be written: " + std::generic_category().message(fault),
                    "check free space and permissions");
}

}  // namespace sheen::capture::synthetic
