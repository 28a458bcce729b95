// SPDX-License-Identifier: MIT
#include "capture/session/avi_writer.h"

#include "capture/session/riff_bytes.h"
#include "core/diagnostics/error.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <limits>

namespace sheen::capture {
namespace {

constexpr std::uint32_t kOpen = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint32_t kHasIndex = 0x10;  // flag of the main header
constexpr std::uint32_t kKeyFrame = 0x10;  // flag of an entry of the AVI 1.0 index
constexpr std::size_t kMostSegments = 256;
constexpr int kFpsScale = 1000;

std::uint32_t size_between(std::uint64_t begin, std::uint64_t end) {
  return static_cast<std::uint32_t>(end - begin);
}

}  // namespace

AviWriter::AviWriter(const std::filesystem::path& path, const ImageSize& size, double fps,
                     std::uint64_t segment_bytes)
    : file_(FileHandle::create(path)), size_(size), fps_(fps), segment_bytes_(segment_bytes) {
  if (put(headers(false)) != 0) {
    throw core::Error(core::Error::Kind::run_failed, path, "cannot be written", "free disk space");
  }
  segments_.push_back({.movie = end_ - 4});
}

int AviWriter::put(const std::vector<std::uint8_t>& bytes) {
  const int fault = file_.write_at(end_, bytes);
  if (fault == 0) {
    end_ += bytes.size();
  } else {
    file_.truncate(end_);
  }
  return fault;
}

int AviWriter::append(std::span<const std::uint8_t> jpeg) {
  constexpr std::uint64_t index_entry = 24;  // of both kinds of index
  const std::uint64_t used = end_ - segments_.back().begin + index_entry * images_.size();
  if (!images_.empty() && used + jpeg.size() > segment_bytes_) {
    if (const int fault = open_segment(); fault != 0) return fault;
  }
  RiffBytes header;
  header.text("00dc");
  header.u32(static_cast<std::uint32_t>(jpeg.size()));
  const std::vector<std::uint8_t> start = header.take();
  chunk_.assign(start.begin(), start.end());
  chunk_.insert(chunk_.end(), jpeg.begin(), jpeg.end());
  if (chunk_.size() % 2 != 0) chunk_.push_back(0);  // chunks start at even places

  const std::uint32_t offset = size_between(segments_.back().movie, end_);
  if (const int fault = put(chunk_); fault != 0) return fault;
  const auto size = static_cast<std::uint32_t>(jpeg.size());
  images_.push_back({offset, size});
  ++segments_.back().frames;
  ++frames_;
  largest_ = std::max(largest_, size);
  return 0;
}

int AviWriter::open_segment() {
  if (segments_.size() == kMostSegments) return EFBIG;
  if (const int fault = close_segment(); fault != 0) return fault;
  const std::uint64_t begin = end_;
  RiffBytes lists;
  lists.text("RIFF");
  lists.u32(kOpen);
  lists.text("AVIXLIST");
  lists.u32(kOpen);
  lists.text("movi");
  if (const int fault = put(lists.take()); fault != 0) return fault;
  segments_.push_back({.begin = begin, .movie = end_ - 4});
  return 0;
}

int AviWriter::close_segment() {
  Segment& segment = segments_.back();
  RiffBytes bytes;
  const std::size_t index = bytes.open("ix00");
  bytes.u16(2);       // words per entry
  bytes.u16(0x0100);  // of chunks, not of indices
  bytes.u32(segment.frames);
  bytes.text("00dc");
  bytes.u64(segment.movie);
  bytes.u32(0);
  for (const Image& image : images_) {
    bytes.u32(image.offset + 8);  // of its data
    bytes.u32(image.size);
  }
  bytes.close(index);
  segment.index = end_;
  segment.index_bytes = static_cast<std::uint32_t>(bytes.size());
  segment.movie_end = end_ + bytes.size();

  if (segments_.size() == 1) {  // the index of AVI 1.0, for players that know no other
    const std::size_t old_index = bytes.open("idx1");
    for (const Image& image : images_) {
      bytes.text("00dc");
      bytes.u32(kKeyFrame);
      bytes.u32(image.offset);
      bytes.u32(image.size);
    }
    bytes.close(old_index);
  }
  if (const int fault = put(bytes.take()); fault != 0) return fault;
  segment.end = end_;
  images_.clear();

  // The first segment's sizes are completed with the headers.
  if (segments_.size() == 1) return 0;
  RiffBytes lists;
  lists.text("RIFF");
  lists.u32(size_between(segment.begin + 8, segment.end));
  lists.text("AVIXLIST");
  lists.u32(size_between(segment.movie, segment.movie_end));
  return file_.write_at(segment.begin, lists.take());
}

int AviWriter::close() {
  if (const int fault = close_segment(); fault != 0) return fault;
  if (const int fault = file_.write_at(0, headers(true)); fault != 0) return fault;
  return file_.flush();
}

std::vector<std::uint8_t> AviWriter::headers(bool is_complete) const {
  RiffBytes bytes;
  bytes.text("RIFF");
  bytes.u32(is_complete ? size_between(8, segments_.front().end) : kOpen);
  bytes.text("AVI ");
  const std::size_t header_list = bytes.open("LIST");
  bytes.text("hdrl");
  put_main_header(bytes, is_complete);
  put_stream_header(bytes, is_complete);
  const std::size_t extended_list = bytes.open("LIST");
  bytes.text("odml");
  const std::size_t extended_header = bytes.open("dmlh");
  bytes.u32(is_complete ? frames_ : 0);
  bytes.close(extended_header);
  bytes.close(extended_list);
  bytes.close(header_list);

  bytes.text("LIST");
  bytes.u32(is_complete ? size_between(segments_.front().movie, segments_.front().movie_end)
                        : kOpen);
  bytes.text("movi");
  return bytes.take();
}

void AviWriter::put_main_header(RiffBytes& bytes, bool is_complete) const {
  const std::size_t main_header = bytes.open("avih");
  bytes.u32(static_cast<std::uint32_t>(std::lround(1e6 / fps_)));
  bytes.zeros(2);  // bytes per second, which are not known, and alignment
  bytes.u32(is_complete ? kHasIndex : 0);
  bytes.u32(is_complete ? segments_.front().frames : 0);
  for (const std::uint32_t word : {0U, 1U, largest_}) bytes.u32(word);
  for (const int side_px : {size_.width_px, size_.height_px}) {
    bytes.u32(static_cast<std::uint32_t>(side_px));
  }
  bytes.zeros(4);
  bytes.close(main_header);
}

void AviWriter::put_stream_header(RiffBytes& bytes, bool is_complete) const {
  const auto width = static_cast<std::uint32_t>(size_.width_px);
  const auto height = static_cast<std::uint32_t>(size_.height_px);
  const std::size_t stream_list = bytes.open("LIST");
  bytes.text("strl");
  const std::size_t stream_header = bytes.open("strh");
  bytes.text("vidsMJPG");
  bytes.zeros(3);
  bytes.u32(kFpsScale);
  bytes.u32(static_cast<std::uint32_t>(std::lround(fps_ * kFpsScale)));
  for (const std::uint32_t word : {0U, is_complete ? frames_ : 0U, largest_, ~0U, 0U}) {
    bytes.u32(word);
  }
  for (const std::uint32_t corner : {0U, 0U, width, height}) bytes.u16(corner);
  bytes.close(stream_header);

  const std::size_t format = bytes.open("strf");
  for (const std::uint32_t word : {40U, width, height}) bytes.u32(word);
  bytes.u16(1);
  bytes.u16(24);
  bytes.text("MJPG");
  bytes.u32(width * height * 3);
  bytes.zeros(4);
  bytes.close(format);
  put_index_of_segments(bytes, is_complete);
  bytes.close(stream_list);
}

/// Room for it is kept from the start.
void AviWriter::put_index_of_segments(RiffBytes& bytes, bool is_complete) const {
  const std::size_t index = bytes.open(is_complete ? "indx" : "JUNK");
  bytes.u16(4);  // words per entry
  bytes.u16(0);  // of indices
  bytes.u32(is_complete ? static_cast<std::uint32_t>(segments_.size()) : 0);
  bytes.text("00dc");
  bytes.zeros(3);
  for (std::size_t i = 0; i < kMostSegments; ++i) {
    const Segment segment = is_complete && i < segments_.size() ? segments_[i] : Segment{};
    bytes.u64(segment.index);
    bytes.u32(segment.index_bytes);
    bytes.u32(segment.frames);
  }
  bytes.close(index);
}

}  // namespace sheen::capture
