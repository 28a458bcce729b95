// SPDX-License-Identifier: MIT
#include "capture/calibration/calibration_images.h"

#include "capture/source/image_check.h"
#include "capture/source/video_source.h"
#include "core/diagnostics/error.h"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <string_view>
#include <vector>

namespace sheen::capture {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 6> kImageEndings{".jpg", ".jpeg", ".png",
                                                        ".bmp", ".tif",  ".tiff"};
constexpr std::array<std::string_view, 3> kRecordings{"frames.avi", "frames.mkv", "frames.mp4"};
constexpr int kMaxSidePx = 1 << 15;

bool is_image(const fs::path& path) {
  std::string ending = path.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return std::find(kImageEndings.begin(), kImageEndings.end(), ending) != kImageEndings.end();
}

/// Whatever images a folder holds, by name; the size of the first binds the others.
class ImageFolder : public FrameSource {
 public:
  explicit ImageFolder(const fs::path& folder) {
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (entry.is_regular_file() && is_image(entry.path())) files_.push_back(entry.path());
    }
    std::sort(files_.begin(), files_.end());
    if (files_.empty()) {
      throw core::bad_input(folder, "holds no images", "name a folder of .jpg or .png files");
    }
  }

  std::optional<Frame> next() override {
    if (next_ == files_.size()) return std::nullopt;
    Frame frame;
    try {
      frame.image = cv::imread(files_[next_].string(), cv::IMREAD_COLOR);
    } catch (const cv::Exception&) {
      frame.image.release();  // more pixels than OpenCV reads
    }
    if (frame.image.empty()) {
      throw core::bad_input(files_[next_], "cannot be read as an image", "remove or replace it");
    }
    const ImageSize size{frame.image.cols, frame.image.rows};
    if (next_ == 0) size_ = size;
    check_image_size(files_[next_], size, size_);
    frame.index = static_cast<int>(next_++);
    frame.time_s = frame.index;
    return frame;
  }

  [[nodiscard]] std::optional<int> frame_count() const override {
    return static_cast<int>(files_.size());
  }

 private:
  std::vector<fs::path> files_;
  std::size_t next_ = 0;
  ImageSize size_;
};

std::unique_ptr<FrameSource> open_whole_video(const fs::path& path) {
  ImageSize size;
  {
    cv::VideoCapture video(path.string(), cv::CAP_FFMPEG);
    size.width_px = static_cast<int>(video.get(cv::CAP_PROP_FRAME_WIDTH));
    size.height_px = static_cast<int>(video.get(cv::CAP_PROP_FRAME_HEIGHT));
    if (!video.isOpened() || size.width_px < 1 || size.height_px < 1 ||
        size.width_px > kMaxSidePx || size.height_px > kMaxSidePx) {
      throw core::bad_input(path, "cannot be decoded as a video",
                            "name a video file or a folder of images");
    }
  }
  return open_video(path, size, {}, std::nullopt);
}

}  // namespace

std::unique_ptr<FrameSource> open_calibration_images(const fs::path& source) {
  std::error_code no_throw;
  if (fs::is_regular_file(source, no_throw)) return open_whole_video(source);
  if (!fs::is_directory(source, no_throw)) {
    throw core::bad_input(source, "there is no such video or folder", "check the path");
  }
  if (fs::is_regular_file(source / "session.json", no_throw)) {
    for (const std::string_view name : kRecordings) {
      if (fs::is_regular_file(source / name, no_throw)) return open_whole_video(source / name);
    }
    if (fs::is_directory(source / "images", no_throw)) {
      return std::make_unique<ImageFolder>(source / "images");
    }
  }
  return std::make_unique<ImageFolder>(source);
}

}  // namespace sheen::capture
