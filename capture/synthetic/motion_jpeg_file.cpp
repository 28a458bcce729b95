// SPDX-License-Identifier: MIT
#include "capture/synthetic/motion_jpeg_file.h"

#include "core/diagnostics/error.h"

#include <opencv2/imgcodecs.hpp>

#include <algorithm>
#include <cassert>
#include <string_view>
#include <utility>

namespace sheen::capture::synthetic {
namespace {

constexpr std::uint32_t kMaxMovieBytes = 2'000'000'000;
constexpr std::uint32_t kHasIndex = 0x10;  // flag of the main header
constexpr std::uint32_t kKeyFrame = 0x10;  // flag of an index entry

/// Little-endian bytes, and chunks whose sizes are known only after they are filled.
class Bytes {
 public:
  void text(std::string_view four_letters) {
    bytes_.insert(bytes_.end(), four_letters.begin(), four_letters.end());
  }
  void u16(std::uint32_t value) {
    for (int shift = 0; shift < 16; shift += 8) {
      bytes_.push_back(static_cast<std::uint8_t>(value >> shift));
    }
  }
  void u32(std::uint32_t value) {
    u16(value & 0xffffU);
    u16(value >> 16);
  }
  void zeros(int words) { bytes_.insert(bytes_.end(), static_cast<std::size_t>(words) * 4, 0); }

  /// Starts a chunk; returns where its size goes.
  std::size_t open(std::string_view name) {
    text(name);
    u32(0);
    return bytes_.size();
  }
  void close(std::size_t begin) {
    const std::size_t size = bytes_.size() - begin;
    for (std::size_t i = 0; i < 4; ++i) {
      bytes_[begin - 4 + i] = static_cast<std::uint8_t>(size >> (8 * i));
    }
  }
  std::vector<std::uint8_t> take() { return std::move(bytes_); }

 private:
  std::vector<std::uint8_t> bytes_;
};

void write_bytes(std::ofstream& file, const std::vector<std::uint8_t>& bytes) {
  file.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

}  // namespace

MotionJpegFile::MotionJpegFile(std::filesystem::path path, cv::Size size_px, int fps, int quality)
    : path_(std::move(path)),
      size_px_(size_px),
      fps_(fps),
      quality_(quality),
      file_(path_, std::ios::binary) {
  write_bytes(file_, headers());
  check_written();
}

void MotionJpegFile::append(const cv::Mat& picture) {
  assert(picture.type() == CV_8UC3 && picture.size() == size_px_);
  cv::imencode(".jpg", picture, jpeg_, {cv::IMWRITE_JPEG_QUALITY, quality_});
  if (jpeg_.size() % 2 != 0) jpeg_.push_back(0);  // chunks start at even places
  if (movie_bytes_ + jpeg_.size() + 8 > kMaxMovieBytes) {
    throw core::Error(core::Error::Kind::run_failed, path_, "would become larger than 2 GB",
                      "ask for fewer frames or a lower quality");
  }

  const auto size = static_cast<std::uint32_t>(jpeg_.size());
  Bytes header;
  header.text("00dc");
  header.u32(size);
  write_bytes(file_, header.take());
  write_bytes(file_, jpeg_);
  check_written();
  chunks_.push_back({movie_bytes_, size});
  movie_bytes_ += size + 8;
}

void MotionJpegFile::close() {
  Bytes index;
  const std::size_t begin = index.open("idx1");
  for (const Chunk& chunk : chunks_) {
    index.text("00dc");
    index.u32(kKeyFrame);
    index.u32(chunk.offset);
    index.u32(chunk.size);
  }
  index.close(begin);
  write_bytes(file_, index.take());
  file_.seekp(0);
  write_bytes(file_, headers());
  file_.close();
  check_written();
}

std::vector<std::uint8_t> MotionJpegFile::headers() const {
  const auto width = static_cast<std::uint32_t>(size_px_.width);
  const auto height = static_cast<std::uint32_t>(size_px_.height);
  const auto fps = static_cast<std::uint32_t>(fps_);
  const auto frames = static_cast<std::uint32_t>(chunks_.size());
  std::uint32_t largest = 0;
  for (const Chunk& chunk : chunks_) largest = std::max(largest, chunk.size);

  Bytes bytes;
  bytes.text("RIFF");
  constexpr std::uint32_t header_bytes = 216;  // from here to the movie's first picture
  bytes.u32(header_bytes + movie_bytes_ - 4 + 8 + 16 * frames);
  bytes.text("AVI ");
  const std::size_t header_list = bytes.open("LIST");
  bytes.text("hdrl");

  const std::size_t main_header = bytes.open("avih");
  for (const std::uint32_t word :
       {1'000'000 / fps, largest * fps, 0U, kHasIndex, frames, 0U, 1U, largest, width, height}) {
    bytes.u32(word);
  }
  bytes.zeros(4);
  bytes.close(main_header);

  const std::size_t stream_list = bytes.open("LIST");
  bytes.text("strl");
  const std::size_t stream_header = bytes.open("strh");
  bytes.text("vidsMJPG");
  for (const std::uint32_t word : {0U, 0U, 0U, 1U, fps, 0U, frames, largest, ~0U, 0U}) {
    bytes.u32(word);
  }
  for (const std::uint32_t corner : {0U, 0U, width, height}) bytes.u16(corner);
  bytes.close(stream_header);
  const std::size_t format = bytes.open("strf");
  bytes.u32(40);
  bytes.u32(width);
  bytes.u32(height);
  bytes.u16(1);
  bytes.u16(24);
  bytes.text("MJPG");
  bytes.u32(width * height * 3);
  bytes.zeros(4);
  bytes.close(format);
  bytes.close(stream_list);
  bytes.close(header_list);

  bytes.text("LIST");
  bytes.u32(movie_bytes_);
  bytes.text("movi");
  std::vector<std::uint8_t> result = bytes.take();
  assert(result.size() == header_bytes + 8);
  return result;
}

void MotionJpegFile::check_written() const {
  if (file_) return;
  throw core::Error(core::Error::Kind::run_failed, path_, "cannot be written",
                    "check free space and permissions");
}

}  // namespace sheen::capture::synthetic
