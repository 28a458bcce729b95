// SPDX-License-Identifier: MIT
#include "capture/calibration/camera_images.h"

#include "capture/session/matroska_muxer.h"
#include "capture/source/jpeg_decoder.h"
#include "capture/source/jpeg_encoder.h"
#include "capture/source/video_source.h"
#include "core/diagnostics/error.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>
#include <vector>

namespace sheen::capture {
namespace {

constexpr double kIntervalS = 1.0 / 3;
constexpr double kSlackS = 0.02;  // a camera's clock trembles
constexpr std::chrono::milliseconds kPatience{1000};
constexpr int kMostSilences = 15;

core::Error silence_of(const Camera& camera) {
  return {core::Error::Kind::run_failed, camera.description().device, "sends no images",
          "check the cable and that nothing else uses it"};
}

bool is_due(double time_s, std::optional<double> last_s) {
  return !last_s || time_s >= *last_s + kIntervalS - kSlackS;
}

class CameraImages : public FrameSource {
 public:
  CameraImages(std::unique_ptr<Camera> camera, double seconds)
      : camera_(std::move(camera)), seconds_(seconds) {}

  std::optional<Frame> next() override {
    for (int silences = 0; silences < kMostSilences;) {
      const auto buffer = camera_->next(kPatience);
      if (!buffer) {
        ++silences;
        continue;
      }
      if (!first_s_) first_s_ = buffer->time_s;
      const double time_s = buffer->time_s - *first_s_;
      if (time_s > seconds_) return std::nullopt;
      if (!is_due(time_s, last_s_)) continue;
      Frame frame;
      if (!decode(*buffer, frame.image)) continue;
      last_s_ = time_s;
      frame.time_s = time_s;
      frame.index = count_++;
      return frame;
    }
    throw silence_of(*camera_);
  }

  [[nodiscard]] std::optional<int> frame_count() const override { return std::nullopt; }

 private:
  bool decode(const CameraBuffer& buffer, cv::Mat& image) {
    const ImageSize size{buffer.width_px, buffer.height_px};
    if (buffer.format == PixelFormat::mjpeg) return decode_jpeg(buffer.bytes, size, image);
    return decode_jpeg(encoder_.encode(buffer), size, image);
  }

  std::unique_ptr<Camera> camera_;
  double seconds_;
  JpegEncoder encoder_;
  std::optional<double> first_s_, last_s_;
  int count_ = 0;
};

/// What a camera of compressed video sends in `seconds`, as the bytes of a Matroska file.
class CameraVideo : public VideoBytes {
 public:
  CameraVideo(Camera& camera, double seconds)
      : camera_(camera),
        seconds_(seconds),
        muxer_(camera.description().video.value(),
               {camera.description().width_px, camera.description().height_px}),
        packed_(joined(muxer_.begin())) {}

  std::size_t read(std::span<std::uint8_t> bytes) override {
    if (taken_ == packed_.size() && !pack_next()) return 0;
    const std::size_t count = std::min(bytes.size(), packed_.size() - taken_);
    std::copy_n(packed_.begin() + static_cast<std::ptrdiff_t>(taken_), count, bytes.begin());
    taken_ += count;
    return count;
  }

 private:
  bool pack_next() {
    for (int silences = 0; silences < kMostSilences; ++silences) {
      const auto buffer = camera_.next(kPatience);
      if (!buffer) continue;
      if (!first_s_) first_s_ = buffer->time_s;
      const double time_s = buffer->time_s - *first_s_;
      if (time_s > seconds_) return false;
      packed_ = joined(muxer_.add({std::make_shared<const std::vector<std::uint8_t>>(
                                       buffer->bytes.begin(), buffer->bytes.end()),
                                   std::llround(time_s * 1e6), buffer->sequence, buffer->is_key}));
      taken_ = 0;
      return true;
    }
    throw silence_of(camera_);
  }

  Camera& camera_;
  double seconds_;
  MatroskaMuxer muxer_;
  std::vector<std::uint8_t> packed_;
  std::size_t taken_ = 0;  ///< of `packed_`
  std::optional<double> first_s_;
};

class CameraVideoImages : public FrameSource {
 public:
  CameraVideoImages(std::unique_ptr<Camera> camera, double seconds)
      : camera_(std::move(camera)), video_(*camera_, seconds) {
    const CameraDescription shown = camera_->description();
    frames_ = open_growing_video(shown.device, video_, {shown.width_px, shown.height_px});
  }

  std::optional<Frame> next() override {
    while (auto frame = frames_->next()) {
      if (!is_due(frame->time_s, last_s_)) continue;
      last_s_ = frame->time_s;
      frame->index = count_++;
      return frame;
    }
    return std::nullopt;
  }

  [[nodiscard]] std::optional<int> frame_count() const override { return std::nullopt; }

  [[nodiscard]] SourceReport report() const override { return frames_->report(); }

 private:
  std::unique_ptr<Camera> camera_;
  CameraVideo video_;
  std::unique_ptr<FrameSource> frames_;
  std::optional<double> last_s_;
  int count_ = 0;
};

}  // namespace

std::unique_ptr<FrameSource> open_camera_images(std::unique_ptr<Camera> camera, double seconds) {
  if (camera->description().video) {
    return std::make_unique<CameraVideoImages>(std::move(camera), seconds);
  }
  return std::make_unique<CameraImages>(std::move(camera), seconds);
}

}  // namespace sheen::capture
