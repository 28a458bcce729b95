// SPDX-License-Identifier: MIT
#pragma once

#include "capture/files/file_handle.h"
#include "capture/source/frame_range.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace sheen::capture {

class RiffBytes;

/// Writes an AVI file of JPEG images as they come: AVI 1.0 with OpenDML segments and indices, so
/// of any length. Until it is closed the headers say that the length is open; whatever happens
/// before, the images that were appended are found by walking the chunks.
class AviWriter {
 public:
  /// Players that know AVI 1.0 only read the first segment.
  static constexpr std::uint64_t kSegmentBytes = std::uint64_t{1} << 30;

  /// Makes the file; `fps` > 0. Throws core::Error: bad_input when it exists or cannot be made,
  /// run_failed when the disk is full.
  AviWriter(const std::filesystem::path& path, const ImageSize& size, double fps,
            std::uint64_t segment_bytes = kSegmentBytes);

  /// Appends an image's bytes as they are. Returns 0 or errno; after a fault nothing of the
  /// image is left.
  [[nodiscard]] int append(std::span<const std::uint8_t> jpeg);

  /// Completes indices and headers. Returns 0 or errno; after a fault the file stays open-ended.
  [[nodiscard]] int close();

  /// Waits until the disk has everything; from any thread. Returns 0 or errno.
  [[nodiscard]] int flush() const { return file_.flush(); }

  /// Of the file.
  [[nodiscard]] std::uint64_t bytes() const { return end_; }

 private:
  /// One RIFF list, its sizes open while it is the last.
  struct Segment {
    std::uint64_t begin = 0;
    std::uint64_t movie = 0;  ///< of the word movi
    std::uint64_t movie_end = 0;
    std::uint64_t end = 0;
    std::uint64_t index = 0;  ///< of its index chunk
    std::uint32_t index_bytes = 0;
    std::uint32_t frames = 0;
  };
  struct Image {
    std::uint32_t offset = 0;  ///< of its chunk, from the word movi of its segment
    std::uint32_t size = 0;
  };

  [[nodiscard]] int put(const std::vector<std::uint8_t>& bytes);
  [[nodiscard]] int open_segment();
  [[nodiscard]] int close_segment();
  [[nodiscard]] std::vector<std::uint8_t> headers(bool is_complete) const;
  void put_main_header(RiffBytes& bytes, bool is_complete) const;
  void put_stream_header(RiffBytes& bytes, bool is_complete) const;
  void put_index_of_segments(RiffBytes& bytes, bool is_complete) const;

  FileHandle file_;
  ImageSize size_;
  double fps_;
  std::uint64_t segment_bytes_;
  std::uint64_t end_ = 0;  ///< of what is written
  std::uint32_t frames_ = 0;
  std::uint32_t largest_ = 0;
  std::vector<Segment> segments_;
  std::vector<Image> images_;  ///< of the last segment
  std::vector<std::uint8_t> chunk_;
};

}  // namespace sheen::capture
