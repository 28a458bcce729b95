// SPDX-License-Identifier: MIT
#include "capture/session/camera_recording.h"

#include "capture/session/frame_stamps.h"
#include "capture/session/live_video.h"
#include "capture/source/avi_reader.h"
#include "capture/source/image_check.h"
#include "capture/source/jpeg_decoder.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <string>
#include <utility>

namespace sheen::capture {
namespace {

constexpr auto kPatience = std::chrono::milliseconds(100);  // how long a stop may go unnoticed
constexpr std::size_t kMostUnrecorded = 3;

}  // namespace

/// Follows the recording's file while it grows.
class LiveFrames : public FrameSource {
 public:
  LiveFrames(CameraRecording& recording, bool takes_unrecorded)
      : recording_(recording),
        takes_unrecorded_(takes_unrecorded),
        reader_(AviReader::open(recording.recorder_.video())) {}

  std::optional<Frame> next() override {
    while (true) {
      const auto time_us = recording_.recorder_.wait_for(read_);
      if (!time_us || !reader_ || !reader_->advance()) return next_unrecorded();
      if (auto frame = decode(reader_->read(), *time_us)) return frame;
    }
  }

  [[nodiscard]] std::optional<int> frame_count() const override { return std::nullopt; }

  [[nodiscard]] SourceReport report() const override { return {damaged_, {}}; }

 private:
  std::optional<Frame> decode(std::span<const std::uint8_t> jpeg, std::int64_t time_us) {
    const int index = read_++;
    const auto size = jpeg_size(jpeg);
    ++damaged_;
    if (!size) return std::nullopt;
    const CameraDescription camera = recording_.status().description;
    check_image_size(camera.device, *size, {camera.width_px, camera.height_px});
    Frame frame;
    if (!decode_jpeg(jpeg, *size, frame.image)) return std::nullopt;
    --damaged_;
    frame.time_s = stamp_seconds(time_us);
    frame.index = index;
    return frame;
  }

  std::optional<Frame> next_unrecorded() {
    if (!takes_unrecorded_) return std::nullopt;
    // First what was taken to be recorded, then what came after the fault.
    while (const auto image = recording_.recorder_.next_unwritten()) {
      if (auto frame = decode(*image->bytes, image->time_us)) return frame;
    }
    while (const auto image = recording_.next_unrecorded()) {
      if (auto frame = decode(*image->bytes, image->time_us)) return frame;
    }
    return std::nullopt;
  }

  CameraRecording& recording_;
  bool takes_unrecorded_;
  std::optional<AviReader> reader_;
  int read_ = 0;
  int damaged_ = 0;
};

CameraRecording::CameraRecording(std::unique_ptr<Camera> camera, SessionRecorder& recorder,
                                 RecordingTerms terms)
    : camera_(std::move(camera)), recorder_(recorder), terms_(std::move(terms)) {
  status_.description = camera_->description();
  thread_ = std::jthread([this](const std::stop_token& stop) { record(stop); });
}

CameraRecording::~CameraRecording() {
  stop();
}

void CameraRecording::stop() {
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
}

std::unique_ptr<FrameSource> CameraRecording::frames() {
  const CameraDescription camera = status().description;
  if (camera.video) return open_live_video(recorder_, camera, true);
  return std::make_unique<LiveFrames>(*this, true);
}

std::unique_ptr<FrameSource> CameraRecording::recorded_frames() {
  const CameraDescription camera = status().description;
  if (camera.video) return open_live_video(recorder_, camera, false);
  return std::make_unique<LiveFrames>(*this, false);
}

RecordingStatus CameraRecording::status() const {
  const std::lock_guard lock(mutex_);
  RecordingStatus status = status_;
  status.recorded = recorder_.written();
  status.disk_fault = recorder_.fault();
  return status;
}

void CameraRecording::record(const std::stop_token& stop) {
  try {
    while (!stop.stop_requested() && !is_over()) {
      if (const auto buffer = camera_->next(kPatience)) take(*buffer);
      report_disk_fault();  // also while the camera is silent
    }
  } catch (const core::Error& error) {
    const std::lock_guard lock(mutex_);
    status_.camera_fault = error;
  } catch (const std::exception& error) {  // no memory, for instance
    const std::lock_guard lock(mutex_);
    status_.camera_fault = core::Error(core::Error::Kind::run_failed, status_.description.device,
                                       std::string("recording has stopped: ") + error.what(),
                                       "what was recorded is kept");
  }
  recorder_.close();
  report_disk_fault();  // found after the last image
  {
    const std::lock_guard lock(mutex_);
    status_.camera = camera_->counts();
    status_.has_ended = true;
  }
  has_unrecorded_.notify_all();
}

bool CameraRecording::is_over() const {
  if (terms_.is_enough && terms_.is_enough()) return true;
  // Pictures of a video that are not in the file are of no use to those that follow.
  if (has_disk_fault_ && camera_->description().video) return true;
  if (terms_.seconds && first_s_ && stamp_seconds(last_us_) >= *terms_.seconds) return true;
  const std::lock_guard lock(mutex_);
  return terms_.frames && status_.taken >= *terms_.frames;
}

void CameraRecording::take(const CameraBuffer& buffer) {
  const bool is_compressed =
      buffer.format == PixelFormat::mjpeg || buffer.format == PixelFormat::video;
  auto bytes = is_compressed ? std::vector<std::uint8_t>(buffer.bytes.begin(), buffer.bytes.end())
                             : encoder_.encode(buffer);
  if (bytes.empty()) {
    const std::lock_guard lock(mutex_);
    ++status_.unreadable;
    return;
  }
  if (!first_s_) first_s_ = buffer.time_s;
  const std::int64_t time_us = std::llround((buffer.time_s - *first_s_) * 1e6);
  last_us_ = std::max(last_us_, time_us);
  // Time never goes back, even if a device that came back says so; but pictures of a video may be
  // stored in another order than they are shown.
  const LiveImage image{std::make_shared<const std::vector<std::uint8_t>>(std::move(bytes)),
                        buffer.format == PixelFormat::video ? time_us : last_us_, buffer.sequence,
                        buffer.is_key};
  needs_key_ = needs_key_ && !image.is_key;
  const bool is_recorded = !needs_key_ && recorder_.add(image);
  needs_key_ = !is_recorded;  // what needs a lost picture is lost with it
  const bool has_fault = report_disk_fault();

  const std::lock_guard lock(mutex_);
  ++status_.taken;
  status_.camera = camera_->counts();
  if (has_fault && !is_recorded) {
    unrecorded_.push_back(image);
    if (unrecorded_.size() > kMostUnrecorded) unrecorded_.pop_front();
    has_unrecorded_.notify_all();
  } else if (!is_recorded) {
    ++status_.dropped;
  }
}

bool CameraRecording::report_disk_fault() {
  const auto fault = recorder_.fault();
  if (!fault) return false;
  if (!has_disk_fault_ && terms_.on_disk_fault) terms_.on_disk_fault(*fault);
  has_disk_fault_ = true;
  return true;
}

std::optional<LiveImage> CameraRecording::next_unrecorded() {
  std::unique_lock lock(mutex_);
  has_unrecorded_.wait(lock, [this] { return !unrecorded_.empty() || status_.has_ended; });
  if (unrecorded_.empty()) return std::nullopt;
  LiveImage image = std::move(unrecorded_.front());
  unrecorded_.pop_front();
  return image;
}

}  // namespace sheen::capture
