// SPDX-License-Identifier: MIT
#include "capture/source/video_source.h"

#include "capture/source/image_check.h"
#include "capture/source/motion_jpeg_source.h"
#include "capture/source/read_ahead_source.h"
#include "capture/source/recording_end.h"
#include "core/diagnostics/error.h"

#include <opencv2/videoio.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace sheen::capture {
namespace {

constexpr double kMaxFrames = 1e8;
constexpr double kFallbackFps = 30;

bool is_usable_fps(double fps) {
  return std::isfinite(fps) && fps > 0.01 && fps < 1e4;
}

/// Any codec, by FFmpeg through OpenCV.
class VideoSource : public FrameSource {
 public:
  VideoSource(const std::filesystem::path& path, const ImageSize& size, const FrameRange& range,
              std::optional<double> fps)
      : path_(path), size_(size), range_(range), given_fps_(fps) {
    open();
    check_range(path_, range_, promised_);
    // Decode the first wanted frame now: faults show before long work starts.
    skip_to_start();
    waiting_ = decode();
  }

  std::optional<Frame> next() override {
    auto frame = std::exchange(waiting_, std::nullopt);
    return frame ? frame : decode();
  }

  [[nodiscard]] std::optional<int> frame_count() const override {
    if (!promised_) return std::nullopt;
    return std::min(*promised_, range_.end.value_or(*promised_)) - range_.start;
  }

 private:
  void open() {
    if (!capture_.open(path_.string(), cv::CAP_FFMPEG)) {
      throw core::bad_input(path_, "cannot be decoded as a video", "check that it is complete");
    }
    const double own_fps = capture_.get(cv::CAP_PROP_FPS);
    file_fps_ = is_usable_fps(own_fps) ? own_fps : given_fps_.value_or(kFallbackFps);
    const double count = capture_.get(cv::CAP_PROP_FRAME_COUNT);
    if (count >= 1 && count < kMaxFrames) promised_ = static_cast<int>(count);
  }

  void skip_to_start() {
    while (decoded_ < range_.start) {
      if (!capture_.grab()) throw early_end(path_, decoded_, promised_);
      note_grabbed();
    }
  }

  std::optional<Frame> decode() {
    if (has_ended_ || (range_.end && decoded_ >= *range_.end)) return std::nullopt;
    cv::Mat image;
    if (!capture_.grab()) {
      has_ended_ = true;
      if (decoded_ == 0 || decoded_ == range_.start ||
          is_short(promised_, decoded_, time_s_ * file_fps_)) {
        throw early_end(path_, decoded_, promised_);
      }
      return std::nullopt;
    }
    const int index = decoded_;
    note_grabbed();
    if (!capture_.retrieve(image) || image.type() != CV_8UC3) {
      throw core::bad_input(path_, "frame " + std::to_string(index) + " cannot be decoded",
                            "record or convert the video again");
    }
    check_image_size(path_, {image.cols, image.rows}, size_);
    return Frame{std::move(image), given_fps_ ? index / *given_fps_ : time_s_, index};
  }

  void note_grabbed() {
    const double position_s = capture_.get(cv::CAP_PROP_POS_MSEC) / 1000;
    // Some containers carry no times; then the frames are evenly spaced.
    if (decoded_ == 0) first_s_ = std::isfinite(position_s) ? position_s : 0;
    const double since_first_s = position_s - first_s_;
    const bool advances = std::isfinite(since_first_s) && since_first_s > time_s_;
    time_s_ = decoded_ == 0 ? 0 : advances ? since_first_s : time_s_ + 1 / file_fps_;
    ++decoded_;
  }

  std::filesystem::path path_;
  ImageSize size_;
  FrameRange range_;
  std::optional<double> given_fps_;
  cv::VideoCapture capture_;
  double file_fps_ = kFallbackFps;
  std::optional<int> promised_;  // frames the container states
  int decoded_ = 0;
  double first_s_ = 0;
  double time_s_ = 0;
  bool has_ended_ = false;
  std::optional<Frame> waiting_;
};

}  // namespace

std::unique_ptr<FrameSource> open_video(const std::filesystem::path& path, const ImageSize& size,
                                        const FrameRange& range, std::optional<double> fps) {
  std::error_code no_throw;
  if (!std::filesystem::is_regular_file(path, no_throw)) {
    throw core::bad_input(path, "there is no such video", "check the path in session.json");
  }
  if (auto source = open_motion_jpeg(path, size, range, fps)) return source;
  try {
    return read_ahead(std::make_unique<VideoSource>(path, size, range, fps));
  } catch (const cv::Exception&) {
    throw core::bad_input(path, "cannot be decoded as a video", "check that it is complete");
  }
}

}  // namespace sheen::capture
