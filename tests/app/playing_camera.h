// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/avi_reader.h"
#include "capture/source/camera.h"
#include "core/diagnostics/error.h"
#include "tests/app/program.h"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>

namespace sheen::tests {

/// Delivers the images of a recording, the sample's as a rule, as fast as they are asked for,
/// starting at some time of a clock. Loses an image now and then, as cameras do.
class PlayingCamera : public capture::Camera {
 public:
  /// Fails after `images`; without a value it goes on to the recording's end.
  explicit PlayingCamera(std::optional<int> images = std::nullopt,
                         const std::filesystem::path& session = sample_session())
      : reader_(capture::AviReader::open(session / "frames.avi")), images_(images) {}

  std::optional<capture::CameraBuffer> next(std::chrono::milliseconds /*timeout*/) override {
    if (images_ == delivered_ || !reader_->advance()) {
      throw core::Error(core::Error::Kind::run_failed, "/dev/played", "was unplugged",
                        "plug it in again");
    }
    if (sequence_ % 10 == 9) ++sequence_, ++counts_.lost;
    ++delivered_;
    const auto& size = reader_->header().size;
    return capture::CameraBuffer{
        capture::PixelFormat::mjpeg, reader_->read(), size.width_px, size.height_px, 0,
        1234.5 + sequence_ / 30.0,   sequence_++};
  }

  [[nodiscard]] capture::CameraDescription description() const override {
    const auto& size = reader_->header().size;
    return {"Player",      "/dev/played",  capture::PixelFormat::mjpeg,
            size.width_px, size.height_px, 30};
  }
  [[nodiscard]] capture::CameraCounts counts() const override { return counts_; }

 private:
  std::optional<capture::AviReader> reader_;
  std::optional<int> images_;
  int delivered_ = 0;
  std::uint32_t sequence_ = 7;
  capture::CameraCounts counts_;
};

}  // namespace sheen::tests
