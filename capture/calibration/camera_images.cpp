// SPDX-License-Identifier: MIT
#include "capture/calibration/camera_images.h"

#include "capture/source/jpeg_decoder.h"
#include "capture/source/jpeg_encoder.h"
#include "core/diagnostics/error.h"

#include <chrono>
#include <utility>

namespace sheen::capture {
namespace {

constexpr double kIntervalS = 1.0 / 3;
constexpr double kSlackS = 0.02;  // a camera's clock trembles
constexpr std::chrono::milliseconds kPatience{1000};
constexpr int kMostSilences = 15;

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
      if (count_ > 0 && time_s < last_s_ + kIntervalS - kSlackS) continue;
      Frame frame;
      if (!decode(*buffer, frame.image)) continue;
      last_s_ = time_s;
      frame.time_s = time_s;
      frame.index = count_++;
      return frame;
    }
    throw core::Error(core::Error::Kind::run_failed, camera_->description().device,
                      "sends no images", "check the cable and that nothing else uses it");
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
  std::optional<double> first_s_;
  double last_s_ = 0;
  int count_ = 0;
};

}  // namespace

std::unique_ptr<FrameSource> open_camera_images(std::unique_ptr<Camera> camera, double seconds) {
  return std::make_unique<CameraImages>(std::move(camera), seconds);
}

}  // namespace sheen::capture
