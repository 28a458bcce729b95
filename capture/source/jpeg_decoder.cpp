// SPDX-License-Identifier: MIT
#include "capture/source/jpeg_decoder.h"

#include <turbojpeg.h>

#include <memory>
#include <string_view>

namespace sheen::capture {
namespace {

struct Destroy {
  void operator()(void* codec) const { tjDestroy(codec); }
};
using Decompressor = std::unique_ptr<void, Destroy>;

/// One for each image (150 ns): a decompressor remembers tables from image to image, and the
/// same bytes must give the same pixels wherever reading starts.
Decompressor make_decompressor() {
  return Decompressor(tjInitDecompress());
}

std::optional<ImageSize> read_size(void* codec, std::span<const std::uint8_t> jpeg) {
  ImageSize size;
  int subsampling = 0, colour_space = 0;
  if (codec == nullptr || tjDecompressHeader3(codec, jpeg.data(), jpeg.size(), &size.width_px,
                                              &size.height_px, &subsampling, &colour_space) != 0) {
    return std::nullopt;
  }
  return size;
}

/// Cameras pad their images; only missing or unreadable image data is damage.
bool is_harmless(std::string_view warning) {
  return warning.find("extraneous bytes") != std::string_view::npos;
}

}  // namespace

std::optional<ImageSize> jpeg_size(std::span<const std::uint8_t> jpeg) {
  return read_size(make_decompressor().get(), jpeg);
}

bool decode_jpeg(std::span<const std::uint8_t> jpeg, const ImageSize& size, cv::Mat& bgr) {
  const Decompressor codec = make_decompressor();
  const auto stated = read_size(codec.get(), jpeg);
  if (stated != size) return false;
  bgr.create(size.height_px, size.width_px, CV_8UC3);
  const int status =
      tjDecompress2(codec.get(), jpeg.data(), jpeg.size(), bgr.data, bgr.cols,
                    static_cast<int>(bgr.step[0]), bgr.rows, TJPF_BGR, TJFLAG_LIMITSCANS);
  if (status == 0) return true;
  return tjGetErrorCode(codec.get()) == TJERR_WARNING && is_harmless(tjGetErrorStr2(codec.get()));
}

}  // namespace sheen::capture
