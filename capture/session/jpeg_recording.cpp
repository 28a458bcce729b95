// SPDX-License-Identifier: MIT
#include "capture/session/jpeg_recording.h"

#include "capture/session/frame_stamps.h"
#include "core/diagnostics/error.h"

#include <span>
#include <string_view>

namespace sheen::capture {
namespace {

std::span<const std::uint8_t> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace

JpegRecording::JpegRecording(const std::filesystem::path& video,
                             const std::filesystem::path& stamps, const ImageSize& size, double fps)
    : video_(video, size, fps), stamps_(FileHandle::create(stamps)) {
  const std::string heading = stamps_heading();
  if (stamps_.write_at(0, bytes_of(heading)) != 0) {
    throw core::Error(core::Error::Kind::run_failed, stamps, "cannot be written",
                      "free disk space");
  }
  stamps_end_ = heading.size();
}

int JpegRecording::append(const LiveImage& image) {
  if (const int status = video_.append(*image.bytes); status != 0) return status;
  // An image counts once its stamp is there.
  const std::string line = stamp_line(count_, image.time_us, image.sequence);
  if (const int status = stamps_.write_at(stamps_end_, bytes_of(line)); status != 0) {
    stamps_.truncate(stamps_end_);
    return status;
  }
  stamps_end_ += line.size();
  ++count_;
  return 0;
}

int JpegRecording::flush() const {
  // Images before stamps: a stamp without its image would say nothing.
  if (const int status = video_.flush(); status != 0) return status;
  return stamps_.flush();
}

}  // namespace sheen::capture
