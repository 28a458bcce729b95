// SPDX-License-Identifier: MIT
#include "capture/source/jpeg_encoder.h"

#include <turbojpeg.h>

#include <algorithm>
#include <array>

namespace sheen::capture {
namespace {

constexpr int kQuality = 95;  // differs from the camera's bytes by less than its own noise

/// Limited range [16, 235] to [0, 255].
constexpr std::uint8_t full_luma(int luma) {
  return static_cast<std::uint8_t>(std::clamp((255 * (luma - 16) + 109) / 219, 0, 255));
}

/// Limited range [16, 240] about 128 to [0, 255].
constexpr std::uint8_t full_chroma(int chroma) {
  const int scaled = 255 * (chroma - 128);
  return static_cast<std::uint8_t>(
      std::clamp(128 + (scaled + (scaled < 0 ? -112 : 112)) / 224, 0, 255));
}

template <typename Map>
constexpr std::array<std::uint8_t, 256> make_table(const Map& map) {
  std::array<std::uint8_t, 256> table{};
  for (int i = 0; i < 256; ++i) table[static_cast<std::size_t>(i)] = map(i);
  return table;
}

constexpr auto kFullLuma = make_table(full_luma);
constexpr auto kFullChroma = make_table(full_chroma);

struct FreeJpeg {
  void operator()(unsigned char* bytes) const { tjFree(bytes); }
};

std::size_t line_bytes(const CameraBuffer& raw, int tight) {
  return static_cast<std::size_t>(std::max(raw.bytes_per_line, tight));
}

}  // namespace

void JpegEncoder::Destroy::operator()(void* codec) const {
  tjDestroy(codec);
}

JpegEncoder::JpegEncoder() : codec_(tjInitCompress()) {}

std::vector<std::uint8_t> JpegEncoder::encode(const CameraBuffer& raw) {
  const bool has_even_size = raw.width_px > 0 && raw.height_px > 0 && raw.width_px % 2 == 0 &&
                             (raw.format == PixelFormat::yuyv || raw.height_px % 2 == 0);
  if (!codec_ || !has_even_size) return {};
  const bool is_split = raw.format == PixelFormat::yuyv   ? split_yuyv(raw)
                        : raw.format == PixelFormat::nv12 ? split_nv12(raw)
                                                          : false;
  if (!is_split) return {};

  const std::array<const unsigned char*, 3> planes{y_.data(), u_.data(), v_.data()};
  const int subsampling = raw.format == PixelFormat::yuyv ? TJSAMP_422 : TJSAMP_420;
  unsigned char* jpeg = nullptr;
  unsigned long size = 0;
  const int status = tjCompressFromYUVPlanes(
      codec_.get(), const_cast<const unsigned char**>(planes.data()), raw.width_px, nullptr,
      raw.height_px, subsampling, &jpeg, &size, kQuality, 0);
  const std::unique_ptr<unsigned char, FreeJpeg> owner(jpeg);
  if (status != 0) return {};
  return {jpeg, jpeg + size};
}

bool JpegEncoder::split_yuyv(const CameraBuffer& raw) {
  const auto width = static_cast<std::size_t>(raw.width_px);
  const auto height = static_cast<std::size_t>(raw.height_px);
  const std::size_t line = line_bytes(raw, 2 * raw.width_px);
  if (raw.bytes.size() < line * (height - 1) + 2 * width) return false;
  y_.resize(width * height);
  u_.resize(width / 2 * height);
  v_.resize(width / 2 * height);
  std::size_t pair = 0;
  for (std::size_t row = 0; row < height; ++row) {
    const std::uint8_t* from = raw.bytes.data() + row * line;
    for (std::size_t i = 0; i < width / 2; ++i, ++pair, from += 4) {
      y_[2 * pair] = kFullLuma[from[0]];
      u_[pair] = kFullChroma[from[1]];
      y_[2 * pair + 1] = kFullLuma[from[2]];
      v_[pair] = kFullChroma[from[3]];
    }
  }
  return true;
}

bool JpegEncoder::split_nv12(const CameraBuffer& raw) {
  const auto width = static_cast<std::size_t>(raw.width_px);
  const auto height = static_cast<std::size_t>(raw.height_px);
  const std::size_t line = line_bytes(raw, raw.width_px);
  const std::size_t rows = height + height / 2;
  if (raw.bytes.size() < line * (rows - 1) + width) return false;
  y_.resize(width * height);
  u_.resize(width / 2 * height / 2);
  v_.resize(width / 2 * height / 2);
  for (std::size_t row = 0; row < height; ++row) {
    const std::uint8_t* from = raw.bytes.data() + row * line;
    for (std::size_t i = 0; i < width; ++i) y_[row * width + i] = kFullLuma[from[i]];
  }
  std::size_t pair = 0;
  for (std::size_t row = height; row < rows; ++row) {
    const std::uint8_t* from = raw.bytes.data() + row * line;
    for (std::size_t i = 0; i < width / 2; ++i, ++pair, from += 2) {
      u_[pair] = kFullChroma[from[0]];
      v_[pair] = kFullChroma[from[1]];
    }
  }
  return true;
}

}  // namespace sheen::capture
