// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/frame_range.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace sheen::capture {

/// The few EXIF facts that change what a picture means.
struct ExifFacts {
  int orientation = 1;            ///< 1 to 8, as TIFF counts
  std::optional<int> focal_35mm;  ///< focal length, mm, on 35 mm film with the same diagonal
  bool is_adobe_rgb = false;      ///< interoperability index R03, or colour space 2
};

/// Reads a TIFF structure, which EXIF is and TIFF files are. Whatever cannot be read is passed
/// over.
ExifFacts read_exif(std::span<const std::uint8_t> tiff);

/// Stored pixels of the first picture of a TIFF file, each side cut off at 2^30; nothing where it
/// does not say.
std::optional<ImageSize> tiff_size(std::span<const std::uint8_t> tiff);

/// Why the colours of the first picture of a TIFF file are not read ("has CMYK colours, as for
/// print"); empty for grey, palettes, RGB and YCbCr in whole numbers of at most 16 bits.
std::string tiff_colour_fault(std::span<const std::uint8_t> tiff);

/// Bits a channel of the first picture of a TIFF file.
int tiff_bits(std::span<const std::uint8_t> tiff);

/// Bytes of the ICC profile of a TIFF file; empty where there is none.
std::span<const std::uint8_t> tiff_profile(std::span<const std::uint8_t> tiff);

}  // namespace sheen::capture
