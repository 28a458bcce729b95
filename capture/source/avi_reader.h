// SPDX-License-Identifier: MIT
#pragma once

#include "capture/files/file_handle.h"
#include "capture/source/frame_range.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace sheen::capture {

/// What the headers of an AVI file say about its images.
struct AviHeader {
  std::string codec;  ///< four letters, such as MJPG
  ImageSize size;
  double fps = 0;             ///< > 0
  double pixel_aspect = 1;    ///< width of a pixel over its height
  std::optional<int> frames;  ///< nothing where the recording was never closed
};

/// The images' bytes of an AVI file, in order. Walks the chunks (AVI 1.0, OpenDML segments) and
/// believes no index and no list's size: what is there of an unfinished recording is found. All
/// sizes are checked against the file.
class AviReader {
 public:
  /// Nothing when the file is no AVI file with images. Throws core::Error (bad_input) when it
  /// cannot be read.
  static std::optional<AviReader> open(const std::filesystem::path& path);

  [[nodiscard]] const AviHeader& header() const { return header_; }

  /// Goes to the next image; false at the end of the file or where it is cut or damaged. Of a
  /// growing file it may be called again later.
  bool advance();

  /// Bytes of the image gone to, valid until the next call of a member; empty when they cannot be
  /// read.
  [[nodiscard]] std::span<const std::uint8_t> read();

  /// Place of the image in time, in frames: a place with an empty chunk has no image.
  [[nodiscard]] int slot() const { return slot_; }

 private:
  struct Chunk {
    std::uint32_t name = 0;
    std::uint64_t begin = 0;  ///< of its data
    std::uint32_t size = 0;
  };

  AviReader(FileHandle file, std::uint64_t file_size)
      : file_(std::move(file)), file_size_(file_size) {}

  std::optional<Chunk> next_chunk();
  [[nodiscard]] bool is_within(const Chunk& chunk) const;
  bool read_headers();
  std::vector<std::uint8_t> read_start(const Chunk& chunk, std::size_t bytes) const;
  void note_stream_header(const Chunk& chunk);
  void note_stream_format(const Chunk& chunk);
  void note_video_properties(const Chunk& chunk);
  [[nodiscard]] bool is_image(std::uint32_t name) const;

  FileHandle file_;
  std::uint64_t file_size_;
  std::uint64_t next_ = 0;  ///< where the next chunk begins
  AviHeader header_;
  int streams_ = 0;        ///< stream headers met
  int video_stream_ = -1;  ///< the first with images
  int slot_ = -1;
  Chunk image_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace sheen::capture
