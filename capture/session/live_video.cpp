// SPDX-License-Identifier: MIT
#include "capture/session/live_video.h"

#include "capture/files/file_handle.h"
#include "capture/session/matroska_muxer.h"
#include "capture/source/video_source.h"
#include "core/diagnostics/error.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace sheen::capture {
namespace {

ImageSize size_of(const CameraDescription& camera) {
  return {camera.width_px, camera.height_px};
}

class RecordingBytes : public VideoBytes {
 public:
  RecordingBytes(SessionRecorder& recorder, const CameraDescription& camera, bool takes_unrecorded)
      : recorder_(recorder),
        takes_unrecorded_(takes_unrecorded),
        file_(FileHandle::open_to_read(recorder.video())),
        muxer_(camera.video.value(), size_of(camera)) {
    static_cast<void>(muxer_.begin());  // which the file has
  }

  std::size_t read(std::span<std::uint8_t> bytes) override {
    if (const auto end = recorder_.wait_for_more(place_)) {
      const std::size_t there = std::min<std::uint64_t>(bytes.size(), *end - place_);
      const std::size_t taken = file_.read_at(place_, bytes.first(there));
      place_ += taken;
      return taken;
    }
    if (!takes_unrecorded_) return 0;
    while (taken_ == unwritten_.size()) {
      const auto image = recorder_.next_unwritten();
      if (!image) return 0;
      unwritten_ = joined(muxer_.add(*image));
      taken_ = 0;
    }
    const std::size_t count = std::min(bytes.size(), unwritten_.size() - taken_);
    std::copy_n(unwritten_.begin() + static_cast<std::ptrdiff_t>(taken_), count, bytes.begin());
    taken_ += count;
    return count;
  }

 private:
  SessionRecorder& recorder_;
  bool takes_unrecorded_;
  FileHandle file_;
  MatroskaMuxer muxer_;  ///< for what does not come to the file
  std::uint64_t place_ = 0;
  std::vector<std::uint8_t> unwritten_;
  std::size_t taken_ = 0;  ///< of `unwritten_`
};

class LiveVideo : public FrameSource {
 public:
  LiveVideo(SessionRecorder& recorder, const CameraDescription& camera, bool takes_unrecorded)
      : recorder_(recorder), size_(size_of(camera)), bytes_(recorder, camera, takes_unrecorded) {}

  std::optional<Frame> next() override {
    if (!frames_ && !open()) return std::nullopt;
    return frames_->next();
  }

  [[nodiscard]] std::optional<int> frame_count() const override { return std::nullopt; }

  [[nodiscard]] SourceReport report() const override {
    return frames_ ? frames_->report() : SourceReport{};
  }

 private:
  /// False when the recording ends before a picture came.
  bool open() {
    try {
      frames_ = open_growing_video(recorder_.video(), bytes_, size_);
    } catch (const core::Error&) {
      if (recorder_.written() > 0) throw;
    }
    return frames_ != nullptr;
  }

  SessionRecorder& recorder_;
  ImageSize size_;
  RecordingBytes bytes_;
  std::unique_ptr<FrameSource> frames_;
};

}  // namespace

std::unique_ptr<FrameSource> open_live_video(SessionRecorder& recorder,
                                             const CameraDescription& camera,
                                             bool takes_unrecorded) {
  return std::make_unique<LiveVideo>(recorder, camera, takes_unrecorded);
}

}  // namespace sheen::capture
