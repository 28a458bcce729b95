// SPDX-License-Identifier: MIT
#include "capture/session/matroska_recording.h"

#include "core/diagnostics/error.h"

#include <algorithm>

namespace sheen::capture {

MatroskaRecording::MatroskaRecording(const std::filesystem::path& path, const VideoHeader& video,
                                     const ImageSize& size)
    : file_(FileHandle::create(path)), muxer_(video, size) {
  if (put(muxer_.begin()) != 0) {
    throw core::Error(core::Error::Kind::run_failed, path, "cannot be written", "free disk space");
  }
}

int MatroskaRecording::put(const std::vector<FilePiece>& pieces) {
  std::uint64_t end = end_;
  for (const FilePiece& piece : pieces) {
    if (const int fault = file_.write_at(piece.offset, piece.bytes); fault != 0) {
      file_.truncate(end_);
      return fault;
    }
    end = std::max(end, piece.offset + piece.bytes.size());
  }
  end_ = end;
  return 0;
}

int MatroskaRecording::append(const LiveImage& image) {
  return put(muxer_.add(image));
}

int MatroskaRecording::close() {
  return put(muxer_.finish());
}

}  // namespace sheen::capture
