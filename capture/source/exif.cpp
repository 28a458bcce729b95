// SPDX-License-Identifier: MIT
#include "capture/source/exif.h"

#include <algorithm>
#include <optional>

namespace sheen::capture {
namespace {

constexpr std::uint16_t kWidth = 0x0100, kHeight = 0x0101, kBits = 0x0102, kColours = 0x0106,
                        kNumberKind = 0x0153, kOrientation = 0x0112, kProfile = 0x8773,
                        kExif = 0x8769, kInteroperability = 0xA005, kColourSpace = 0xA001,
                        kFocal35mm = 0xA405, kIndex = 0x0001;
constexpr std::uint16_t kShort = 3;

/// Numbers of a TIFF structure in its byte order; nothing beyond its end.
class TiffBytes {
 public:
  explicit TiffBytes(std::span<const std::uint8_t> bytes) : bytes_(bytes) {
    is_big_ = bytes.size() > 1 && bytes[0] == 'M' && bytes[1] == 'M';
    is_tiff_ = bytes.size() >= 8 && (is_big_ || (bytes[0] == 'I' && bytes[1] == 'I')) &&
               number(2, 2) == 42;
  }

  [[nodiscard]] bool is_tiff() const { return is_tiff_; }

  /// `size` bytes at `offset` as a number.
  [[nodiscard]] std::optional<std::uint32_t> number(std::size_t offset, std::size_t size) const {
    if (offset > bytes_.size() || bytes_.size() - offset < size) return std::nullopt;
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t place = is_big_ ? i : size - 1 - i;
      value = value << 8U | bytes_[offset + place];
    }
    return value;
  }

  /// Where the 12 bytes of an entry lie, in the directory at `directory`.
  [[nodiscard]] std::optional<std::size_t> find(std::size_t directory, std::uint16_t tag) const {
    const auto count = number(directory, 2);
    for (std::size_t i = 0; count && i < *count; ++i) {
      const std::size_t entry = directory + 2 + 12 * i;
      const auto found = number(entry, 2);
      if (!found) break;
      if (*found == tag) return entry;
    }
    return std::nullopt;
  }

  /// A small number, or an offset, as an entry holds it.
  [[nodiscard]] std::optional<std::uint32_t> value(std::size_t directory, std::uint16_t tag) const {
    const auto entry = find(directory, tag);
    if (!entry) return std::nullopt;
    return number(*entry + 8, number(*entry + 2, 2) == kShort ? 2 : 4);
  }

  /// The first of a list of small numbers, which lies elsewhere where it has more than two.
  [[nodiscard]] std::optional<std::uint32_t> first_of(std::size_t directory,
                                                      std::uint16_t tag) const {
    const auto entry = find(directory, tag);
    if (!entry || number(*entry + 2, 2) != kShort) return std::nullopt;
    if (number(*entry + 4, 4).value_or(0) <= 2) return number(*entry + 8, 2);
    const auto place = number(*entry + 8, 4);
    return place ? number(*place, 2) : std::nullopt;
  }

  [[nodiscard]] std::size_t first_directory() const { return number(4, 4).value_or(0); }

  [[nodiscard]] std::span<const std::uint8_t> part(std::size_t offset, std::size_t length) const {
    if (offset > bytes_.size() || length > bytes_.size() - offset) return {};
    return bytes_.subspan(offset, length);
  }

 private:
  std::span<const std::uint8_t> bytes_;
  bool is_big_ = false;
  bool is_tiff_ = false;
};

}  // namespace

ExifFacts read_exif(std::span<const std::uint8_t> tiff) {
  ExifFacts facts;
  const TiffBytes bytes(tiff);
  if (!bytes.is_tiff()) return facts;
  const std::size_t first = bytes.first_directory();
  if (const auto orientation = bytes.value(first, kOrientation)) {
    if (*orientation >= 1 && *orientation <= 8) {
      facts.orientation = static_cast<int>(*orientation);
    }
  }
  const auto exif = bytes.value(first, kExif);
  if (!exif) return facts;
  const auto focal = bytes.value(*exif, kFocal35mm);
  if (focal && *focal > 0 && *focal < 10'000) facts.focal_35mm = static_cast<int>(*focal);
  if (bytes.value(*exif, kColourSpace) == 2U) facts.is_adobe_rgb = true;
  if (const auto interoperability = bytes.value(*exif, kInteroperability)) {
    // "R03" in the four bytes of the entry itself.
    if (const auto entry = bytes.find(*interoperability, kIndex)) {
      const auto text = bytes.part(*entry + 8, 3);
      if (text.size() == 3 && text[0] == 'R' && text[1] == '0' && text[2] == '3') {
        facts.is_adobe_rgb = true;
      }
    }
  }
  return facts;
}

std::optional<ImageSize> tiff_size(std::span<const std::uint8_t> tiff) {
  const TiffBytes bytes(tiff);
  if (!bytes.is_tiff()) return std::nullopt;
  const auto width = bytes.value(bytes.first_directory(), kWidth);
  const auto height = bytes.value(bytes.first_directory(), kHeight);
  if (!width || !height) return std::nullopt;
  constexpr std::uint32_t most = 1U << 30U;
  return ImageSize{static_cast<int>(std::min(most, *width)),
                   static_cast<int>(std::min(most, *height))};
}

std::string tiff_colour_fault(std::span<const std::uint8_t> tiff) {
  const TiffBytes bytes(tiff);
  if (!bytes.is_tiff()) return {};
  const std::size_t first = bytes.first_directory();
  // TIFF 6.0, PhotometricInterpretation, and DNG's two.
  switch (bytes.first_of(first, kColours).value_or(2)) {
    case 5:
      return "has CMYK colours, as for print";
    case 8:
    case 9:
    case 10:
      return "has Lab colours";
    case 32803:
    case 34892:
      return "holds a camera's raw data";
    case 32844:
    case 32845:
      return "has logarithmic colours (LogLuv)";
    default:
      break;
  }
  constexpr std::uint32_t is_float = 3, most_bits = 16;
  if (bytes.first_of(first, kNumberKind) == is_float) return "has colours in floating point";
  if (bytes.first_of(first, kBits).value_or(8) > most_bits) {
    return "has more than 16 bits a channel";
  }
  return {};
}

int tiff_bits(std::span<const std::uint8_t> tiff) {
  const TiffBytes bytes(tiff);
  if (!bytes.is_tiff()) return 8;
  return static_cast<int>(bytes.first_of(bytes.first_directory(), kBits).value_or(8));
}

std::span<const std::uint8_t> tiff_profile(std::span<const std::uint8_t> tiff) {
  const TiffBytes bytes(tiff);
  if (!bytes.is_tiff()) return {};
  const auto entry = bytes.find(bytes.first_directory(), kProfile);
  if (!entry) return {};
  return bytes.part(bytes.number(*entry + 8, 4).value_or(0),
                    bytes.number(*entry + 4, 4).value_or(0));
}

}  // namespace sheen::capture
