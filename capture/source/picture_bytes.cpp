// SPDX-License-Identifier: MIT
#include "capture/source/picture_bytes.h"

#include "capture/files/file_handle.h"
#include "core/diagnostics/error.h"

namespace sheen::capture {
namespace {

constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 30;
constexpr int kMostSide_px = 1 << 15;
/// Of one byte: zlib packs 1032 to 1, and a byte may hold eight pixels. No other kind packs more.
constexpr std::uint64_t kMostPixelsOfAByte = 8 * 1032;

core::Error unusable(const std::filesystem::path& path, const std::string& fault) {
  return core::bad_input(path, fault, "check that it is complete, or leave it out");
}

}  // namespace

std::vector<std::uint8_t> read_picture_bytes(const std::filesystem::path& path) {
  std::error_code no_throw;
  if (!std::filesystem::exists(path, no_throw)) {
    throw core::bad_input(path, "there is no such image", "check the path");
  }
  if (!std::filesystem::is_regular_file(path, no_throw)) {  // a folder, a pipe
    throw core::bad_input(path, "is no file", "put an image there");
  }
  const FileHandle file = FileHandle::open_to_read(path);
  const std::uint64_t size = file.size();
  if (size == 0) throw unusable(path, "is empty");
  if (size > kMostBytes) throw unusable(path, "is larger than a picture can be");
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
  if (file.read_at(0, bytes) != bytes.size()) throw unusable(path, "cannot be read to its end");
  return bytes;
}

void check_picture_size(const std::filesystem::path& path, const ImageSize& stored,
                        std::uint64_t bytes) {
  const auto [width_px, height_px] = stored;
  if (width_px < 1 || height_px < 1 || width_px > kMostSide_px || height_px > kMostSide_px) {
    throw unusable(path, "cannot be read as an image");
  }
  const auto pixels = static_cast<std::uint64_t>(width_px) * static_cast<std::uint64_t>(height_px);
  if (pixels > kMostPixelsOfAByte * bytes) {
    throw unusable(path, "cannot be read as an image: it is cut short or damaged");
  }
}

}  // namespace sheen::capture
