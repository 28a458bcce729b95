// SPDX-License-Identifier: MIT
#include "capture/source/avi_reader.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>
#include <string_view>

namespace sheen::capture {
namespace {

constexpr std::uint32_t kMostFrames = 100'000'000;

std::uint32_t u32(const std::uint8_t* bytes) {
  return bytes[0] | std::uint32_t{bytes[1]} << 8 | std::uint32_t{bytes[2]} << 16 |
         std::uint32_t{bytes[3]} << 24;
}

constexpr std::uint32_t letters(std::string_view four) {
  std::uint32_t name = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    name |= static_cast<std::uint32_t>(static_cast<std::uint8_t>(four[i])) << (8 * i);
  }
  return name;
}

char letter(std::uint32_t name, int place) {
  return static_cast<char>(name >> (8 * place) & 0xff);
}

/// Chunk names are printable; anything else is no chunk, but damage or a file's cut tail.
bool is_name(std::uint32_t name) {
  for (int i = 0; i < 4; ++i) {
    if (std::isprint(static_cast<unsigned char>(letter(name, i))) == 0) return false;
  }
  return true;
}

bool has_inner_chunks(std::uint32_t list_type) {
  constexpr std::array known{letters("AVI "), letters("AVIX"), letters("hdrl"),
                             letters("strl"), letters("movi"), letters("rec ")};
  return std::find(known.begin(), known.end(), list_type) != known.end();
}

}  // namespace

std::optional<AviReader> AviReader::open(const std::filesystem::path& path) {
  FileHandle file = FileHandle::open_to_read(path);
  const std::uint64_t size = file.size();
  std::array<std::uint8_t, 12> start{};
  if (file.read_at(0, start) != start.size() || u32(start.data()) != letters("RIFF") ||
      u32(start.data() + 8) != letters("AVI ")) {
    return std::nullopt;
  }
  AviReader reader(std::move(file), size);
  if (!reader.read_headers()) return std::nullopt;
  return reader;
}

std::optional<AviReader::Chunk> AviReader::next_chunk() {
  // Every turn goes at least 8 bytes on, so this ends.
  while (true) {
    std::array<std::uint8_t, 12> start{};
    const std::size_t count = file_.read_at(next_, start);
    if (count < 8) return std::nullopt;
    const Chunk chunk{u32(start.data()), next_ + 8, u32(start.data() + 4)};
    if (!is_name(chunk.name)) return std::nullopt;

    // Lists are entered whatever size they claim: of an unfinished recording it is not known.
    const bool is_list = chunk.name == letters("RIFF") || chunk.name == letters("LIST");
    if (is_list && count == start.size() && has_inner_chunks(u32(start.data() + 8))) {
      next_ += 12;
      if (u32(start.data() + 8) == letters("movi")) return Chunk{letters("movi"), next_, 0};
      continue;
    }
    if (!is_within(chunk)) {
      file_size_ = file_.size();  // the file may still be growing
      if (!is_within(chunk)) return std::nullopt;
    }
    next_ = chunk.begin + chunk.size + chunk.size % 2;
    return chunk;
  }
}

bool AviReader::is_within(const Chunk& chunk) const {
  return chunk.begin <= file_size_ && chunk.size <= file_size_ - chunk.begin;
}

bool AviReader::read_headers() {
  while (const auto chunk = next_chunk()) {
    if (chunk->name == letters("movi")) return video_stream_ >= 0 && !header_.codec.empty();
    if (chunk->name == letters("strh")) note_stream_header(*chunk);
    if (chunk->name == letters("strf")) note_stream_format(*chunk);
    if (chunk->name == letters("vprp")) note_video_properties(*chunk);
  }
  return false;
}

std::vector<std::uint8_t> AviReader::read_start(const Chunk& chunk, std::size_t bytes) const {
  std::vector<std::uint8_t> start(bytes);
  if (chunk.size < bytes || file_.read_at(chunk.begin, start) != bytes) start.clear();
  return start;
}

void AviReader::note_stream_header(const Chunk& chunk) {
  const int stream = streams_++;
  const auto start = read_start(chunk, 36);
  if (video_stream_ >= 0 || start.empty() || u32(start.data()) != letters("vids")) return;
  const std::uint32_t scale = u32(start.data() + 20);
  const std::uint32_t rate = u32(start.data() + 24);
  const std::uint32_t length = u32(start.data() + 32);
  if (scale == 0 || rate == 0) return;
  video_stream_ = stream;
  header_.fps = static_cast<double>(rate) / scale;
  if (length > 0 && length <= kMostFrames) header_.frames = static_cast<int>(length);
}

void AviReader::note_stream_format(const Chunk& chunk) {
  if (video_stream_ < 0 || video_stream_ != streams_ - 1) return;
  const auto start = read_start(chunk, 20);
  if (start.empty()) return;
  constexpr std::uint32_t most = std::numeric_limits<std::uint16_t>::max();
  const std::uint32_t width = u32(start.data() + 4);
  const std::uint32_t height = u32(start.data() + 8);
  if (width > most || height > most) return;
  header_.size = {static_cast<int>(width), static_cast<int>(height)};
  header_.codec.clear();
  for (int i = 0; i < 4; ++i) header_.codec += letter(u32(start.data() + 16), i);
}

// OpenDML 1.02: the aspect of the whole frame, height in the lower half, and its size in pixels.
// Zeros give no number within the limits.
void AviReader::note_video_properties(const Chunk& chunk) {
  constexpr double widest = 8;  // beyond it, it is no statement about a camera's pixels
  if (video_stream_ < 0 || video_stream_ != streams_ - 1) return;
  const auto start = read_start(chunk, 32);
  if (start.empty()) return;
  const std::uint32_t aspect = u32(start.data() + 20);
  const double frame_aspect = static_cast<double>(aspect >> 16) / (aspect & 0xffff);
  const double pixels_across = static_cast<double>(u32(start.data() + 24)) / u32(start.data() + 28);
  const double pixel_aspect = frame_aspect / pixels_across;
  if (pixel_aspect >= 1 / widest && pixel_aspect <= widest) header_.pixel_aspect = pixel_aspect;
}

bool AviReader::is_image(std::uint32_t name) const {
  const std::uint32_t kind = name >> 16;
  return letter(name, 0) == static_cast<char>('0' + video_stream_ / 10) &&
         letter(name, 1) == static_cast<char>('0' + video_stream_ % 10) &&
         (kind == letters("00dc") >> 16 || kind == letters("00db") >> 16);
}

bool AviReader::advance() {
  while (const auto chunk = next_chunk()) {
    if (!is_image(chunk->name)) continue;
    ++slot_;
    if (chunk->size == 0) continue;
    image_ = *chunk;
    return true;
  }
  return false;
}

std::span<const std::uint8_t> AviReader::read() {
  bytes_.resize(image_.size);
  if (file_.read_at(image_.begin, bytes_) != bytes_.size()) bytes_.clear();
  return bytes_;
}

}  // namespace sheen::capture
