// SPDX-License-Identifier: MIT
#pragma once

#include "capture/session/recorded_video.h"
#include "capture/source/camera.h"
#include "capture/source/frame_range.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace sheen::capture {

/// Bytes and where in the file they belong.
struct FilePiece {
  std::uint64_t offset = 0;
  std::vector<std::uint8_t> bytes;
};

/// Packs pictures of a compressed video into Matroska, as they are, by FFmpeg. Every picture is a
/// cluster of its own, so that the file is whole after each of them. Times are rounded to
/// milliseconds. Throws std::runtime_error where FFmpeg fails, which takes a lack of memory.
class MatroskaMuxer {
 public:
  MatroskaMuxer(const VideoHeader& video, const ImageSize& size);
  ~MatroskaMuxer();
  MatroskaMuxer(MatroskaMuxer&&) noexcept;
  MatroskaMuxer& operator=(MatroskaMuxer&&) noexcept;
  MatroskaMuxer(const MatroskaMuxer&) = delete;
  MatroskaMuxer& operator=(const MatroskaMuxer&) = delete;

  /// What the file begins with, to be taken before anything is added.
  std::vector<FilePiece> begin();
  /// What a picture adds at the end; such bytes may be left out and mean the same at any place.
  std::vector<FilePiece> add(const LiveImage& picture);
  /// Index and length; also changes bytes that were written before.
  std::vector<FilePiece> finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// All the bytes of pieces that follow each other.
std::vector<std::uint8_t> joined(const std::vector<FilePiece>& pieces);

}  // namespace sheen::capture
