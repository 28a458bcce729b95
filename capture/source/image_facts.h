// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/frame_range.h"
#include "capture/source/quarter_turn.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace sheen::capture {

/// What the bytes of a picture say about it, whatever its name.
enum class ImageKind {
  jpeg,
  png,
  tiff,
  bmp,
  webp,
  heif,
  avif,
  jpeg_xl,
  gif,
  big_tiff,
  raw,
  unknown
};

struct ImageFacts {
  ImageKind kind = ImageKind::unknown;
  std::optional<ImageSize> size;      ///< stored pixels, where the headers say
  int channels = 0;                   ///< of JPEG: 1, 3 or 4; else 0
  int bits = 8;                       ///< a channel, of PNG and TIFF
  Orientation orientation;            ///< EXIF
  std::vector<std::uint8_t> profile;  ///< ICC profile; empty where there is none
  bool is_adobe_rgb = false;          ///< EXIF says so, as cameras do without a profile
  std::optional<int> focal_35mm;      ///< EXIF: mm, on 35 mm film with the same diagonal
  std::optional<double> gamma;        ///< of PNG, where nothing else says what its colours are
  std::string colour_fault;  ///< of TIFF: why its colours are not read; empty where they are
  std::string colour_doubt;  ///< of PNG: other colours than sRGB that it states, without a profile
};

/// Reads headers only, and believes no length beyond the bytes.
ImageFacts read_image_facts(std::span<const std::uint8_t> bytes);

/// "HEIC" and what to do about it, for pictures of kinds that are not read; nothing for the others.
struct UnreadableKind {
  std::string name;
  std::string remedy;
};
std::optional<UnreadableKind> unreadable_kind(ImageKind kind);

/// The same by the ending of a name, for files nobody wants to open: .heic, .cr2, .dng, ...
std::optional<UnreadableKind> unreadable_ending(const std::filesystem::path& path);

}  // namespace sheen::capture
