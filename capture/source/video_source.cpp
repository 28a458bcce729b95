// SPDX-License-Identifier: MIT
#include "capture/source/video_source.h"

#include "capture/source/image_check.h"
#include "capture/source/motion_jpeg_source.h"
#include "capture/source/pixel_aspect.h"
#include "capture/source/quarter_turn.h"
#include "capture/source/read_ahead_source.h"
#include "capture/source/recording_end.h"
#include "capture/source/stated_rate.h"
#include "capture/source/video_colour.h"
#include "capture/source/video_decoder.h"
#include "core/diagnostics/error.h"

extern "C" {
#include <libavutil/frame.h>
}

#include <algorithm>
#include <string>
#include <utility>

namespace sheen::capture {
namespace {

constexpr double kFallbackFps = 30;
constexpr int kMaxSidePx = 1 << 15;

/// Any codec, by FFmpeg.
class VideoSource : public FrameSource {
 public:
  VideoSource(const std::filesystem::path& path, VideoDecoder decoder, const ImageSize& size,
              const FrameRange& range, std::optional<double> fps, std::optional<double> focal_ratio)
      : path_(path),
        size_(size),
        range_(range),
        decoder_(std::move(decoder)),
        file_fps_(decoder_.facts().fps.value_or(fps.value_or(kFallbackFps))),
        promised_(decoder_.facts().frames),
        rate_(fps),
        focal_ratio_(focal_ratio) {
    check_range(path_, range_, promised_);
    const ImageSize stated = decoder_.facts().size;
    if (stated.width_px > 0) choose_orientation(stated);
    // Decode the first wanted frame now: faults show before long work starts.
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

  [[nodiscard]] SourceReport report() const override {
    // What may make poses wrong comes first.
    SourceReport report{decoder_.damaged(), {}};
    std::string aspect = aspect_doubt(decoder_.facts().pixel_aspect, focal_ratio_);
    if (!aspect.empty()) report.notes.push_back(std::move(aspect));
    if (!turn_.note.empty()) report.notes.push_back(turn_.note);
    for (const std::string& note : colour_.notes()) report.notes.push_back(note);
    if (auto disagreement = rate_.disagreement()) report.notes.push_back(*disagreement);
    for (std::string& note : report.notes) note = path_.string() + ": " + note;
    return report;
  }

 private:
  void choose_orientation(const ImageSize& stored) {
    refuse_shown_size(path_, stored, size_, decoder_.facts().pixel_aspect);
    turn_ = choose_turn(path_, stored, size_, decoder_.facts().orientation);
    stored_ = stored;
  }

  std::optional<Frame> decode() {
    if (has_ended_ || (range_.end && decoded_ >= *range_.end)) return std::nullopt;
    while (decoder_.next()) {
      const double own_time_s = decoder_.time_s();
      const double since_last_s = decoded_ > 0 ? own_time_s - last_s_ : 0;
      decoded_ = decoder_.index() + 1;
      last_s_ = own_time_s;
      if (range_.end && decoder_.index() >= *range_.end) break;
      if (decoder_.facts().has_own_times) rate_.compare(decoder_.index(), own_time_s);
      if (decoder_.index() < range_.start) continue;
      return frame_of(decoder_.picture(), own_time_s, since_last_s);
    }
    has_ended_ = true;
    const bool lacks_all = decoded_ <= range_.start;
    if (range_.end && decoded_ >= *range_.end && !lacks_all) return std::nullopt;
    if (lacks_all || is_short(promised_, decoded_, last_s_ * file_fps_)) {
      throw early_end(path_, decoded_, promised_);
    }
    return std::nullopt;
  }

  Frame frame_of(const AVFrame& picture, double own_time_s, double since_last_s) {
    const ImageSize stored{picture.width, picture.height};
    if (!(stored == stored_)) choose_orientation(stored);
    Frame frame;
    std::string fault;
    if (!colour_.convert(picture, frame.image, fault)) {
      throw core::bad_input(path_, fault, "convert it to an ordinary 8-bit video (BT.709)");
    }
    if (turn_.turns) frame.image = turned(frame.image, decoder_.facts().orientation);
    frame.index = decoder_.index();
    frame.time_s = rate_.time_s(frame.index).value_or(own_time_s);
    frame.spacing_s = rate_.spacing_s().value_or(since_last_s > 0 ? since_last_s : 1 / file_fps_);
    return frame;
  }

  std::filesystem::path path_;
  ImageSize size_;
  FrameRange range_;
  VideoDecoder decoder_;
  double file_fps_ = kFallbackFps;
  std::optional<int> promised_;  // frames the container states
  StatedRate rate_;
  std::optional<double> focal_ratio_;  // fy / fx of the camera
  VideoColour colour_;
  ImageSize stored_;
  TurnChoice turn_;
  int decoded_ = 0;  ///< frames gone past, damaged ones included
  double last_s_ = 0;
  bool has_ended_ = false;
  std::optional<Frame> waiting_;
};

void check_is_file(const std::filesystem::path& path) {
  std::error_code no_throw;
  if (!std::filesystem::is_regular_file(path, no_throw)) {
    throw core::bad_input(path, "there is no such video", "check the path in session.json");
  }
}

}  // namespace

ImageSize stored_video_size(const std::filesystem::path& path) {
  check_is_file(path);
  const ImageSize size = VideoDecoder(path).facts().size;
  if (size.width_px < 1 || size.height_px < 1 || size.width_px > kMaxSidePx ||
      size.height_px > kMaxSidePx) {
    throw core::bad_input(path, "cannot be decoded as a video", "check that it is complete");
  }
  return size;
}

double video_pixel_aspect(const std::filesystem::path& path) {
  check_is_file(path);
  return VideoDecoder(path).facts().pixel_aspect;
}

std::unique_ptr<FrameSource> open_video(const std::filesystem::path& path, const ImageSize& size,
                                        const FrameRange& range, std::optional<double> fps,
                                        std::optional<double> focal_ratio) {
  check_is_file(path);
  if (auto source = open_motion_jpeg(path, size, range, fps, focal_ratio)) return source;
  return read_ahead(
      std::make_unique<VideoSource>(path, VideoDecoder(path, size), size, range, fps, focal_ratio));
}

std::unique_ptr<FrameSource> open_growing_video(const std::filesystem::path& name,
                                                VideoBytes& bytes, const ImageSize& size) {
  return std::make_unique<VideoSource>(name, VideoDecoder(name, bytes), size, FrameRange{},
                                       std::nullopt, std::nullopt);
}

}  // namespace sheen::capture
