// SPDX-License-Identifier: MIT
#include "capture/source/motion_jpeg_source.h"

#include "capture/source/avi_reader.h"
#include "capture/source/image_check.h"
#include "capture/source/jpeg_decoder.h"
#include "capture/source/pixel_aspect.h"
#include "capture/source/recording_end.h"
#include "capture/source/stated_rate.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

namespace sheen::capture {
namespace {

/// Interlaced recordings hold two half images each, which FFmpeg can join.
bool has_whole_images(AviReader& reader) {
  while (reader.advance()) {
    if (const auto stated = jpeg_size(reader.read())) return *stated == reader.header().size;
  }
  return true;
}

class MotionJpegSource : public FrameSource {
 public:
  MotionJpegSource(std::filesystem::path path, AviReader reader, const ImageSize& size,
                   const FrameRange& range, std::optional<double> fps,
                   std::optional<double> focal_ratio)
      : path_(std::move(path)),
        reader_(std::move(reader)),
        size_(size),
        range_(range),
        rate_(fps),
        focal_ratio_(focal_ratio) {
    check_range(path_, range_, promised());
    refuse_shown_size(path_, reader_.header().size, size_, reader_.header().pixel_aspect);
    // Decode the first wanted frame now: faults show before long work starts.
    while (read_ < range_.start) {
      if (!advance()) throw early_end(path_, read_, promised());
    }
    waiting_ = decode();
    if (!waiting_) throw early_end(path_, read_, promised());
  }

  std::optional<Frame> next() override {
    auto frame = std::exchange(waiting_, std::nullopt);
    return frame ? std::move(frame) : decode();
  }

  bool skip() override {
    if (std::exchange(waiting_, std::nullopt)) return true;
    return (!range_.end || read_ < *range_.end) && advance_or_refuse();
  }

  [[nodiscard]] std::optional<int> frame_count() const override {
    if (!promised() && !range_.end) return std::nullopt;
    constexpr int most = std::numeric_limits<int>::max();
    return std::min(promised().value_or(most), range_.end.value_or(most)) - range_.start;
  }

  [[nodiscard]] SourceReport report() const override {
    SourceReport report{damaged_, {}};
    std::string aspect = aspect_doubt(reader_.header().pixel_aspect, focal_ratio_);
    if (!aspect.empty()) report.notes.push_back(std::move(aspect));
    if (auto disagreement = rate_.disagreement()) report.notes.push_back(*disagreement);
    for (std::string& note : report.notes) note = path_.string() + ": " + note;
    return report;
  }

 private:
  [[nodiscard]] std::optional<int> promised() const { return reader_.header().frames; }

  bool advance() {
    if (!reader_.advance()) return false;
    if (read_ == 0) first_slot_ = reader_.slot();
    ++read_;
    return true;
  }

  /// False at the end; throws where that comes too early.
  bool advance_or_refuse() {
    if (advance()) return true;
    if (is_short(promised(), read_, reader_.slot() - first_slot_)) {
      throw early_end(path_, read_, promised());
    }
    return false;
  }

  std::optional<Frame> decode() {
    while (!range_.end || read_ < *range_.end) {
      if (!advance_or_refuse()) return std::nullopt;
      const auto jpeg = reader_.read();
      const auto stated = jpeg_size(jpeg);
      if (stated) check_image_size(path_, *stated, size_);
      Frame frame;
      if (!stated || !decode_jpeg(jpeg, size_, frame.image)) {
        ++damaged_;
        continue;
      }
      frame.index = read_ - 1;
      const double own_time_s = (reader_.slot() - first_slot_) / reader_.header().fps;
      rate_.compare(frame.index, own_time_s);
      frame.time_s = rate_.time_s(frame.index).value_or(own_time_s);
      frame.spacing_s = rate_.spacing_s().value_or(1 / reader_.header().fps);
      return frame;
    }
    return std::nullopt;
  }

  std::filesystem::path path_;
  AviReader reader_;
  ImageSize size_;
  FrameRange range_;
  StatedRate rate_;
  std::optional<double> focal_ratio_;  ///< fy / fx of the camera
  int damaged_ = 0;
  int read_ = 0;  ///< images gone past, damaged ones included
  int first_slot_ = 0;
  std::optional<Frame> waiting_;
};

}  // namespace

std::unique_ptr<FrameSource> open_motion_jpeg(const std::filesystem::path& path,
                                              const ImageSize& size, const FrameRange& range,
                                              std::optional<double> fps,
                                              std::optional<double> focal_ratio) {
  auto reader = AviReader::open(path);
  if (!reader || reader->header().codec != "MJPG" || !has_whole_images(*reader)) return nullptr;
  reader = AviReader::open(path);  // again from its first image
  return std::make_unique<MotionJpegSource>(path, std::move(*reader), size, range, fps,
                                            focal_ratio);
}

}  // namespace sheen::capture
