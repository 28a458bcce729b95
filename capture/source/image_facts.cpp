// SPDX-License-Identifier: MIT
#include "capture/source/image_facts.h"

#include "capture/source/exif.h"
#include "core/text/lower_case.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>

namespace sheen::capture {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::size_t kMostProfile = std::size_t{8} << 20;

bool starts_with(Bytes bytes, std::string_view text, std::size_t offset = 0) {
  if (bytes.size() < offset + text.size()) return false;
  return std::equal(text.begin(), text.end(), bytes.begin() + static_cast<std::ptrdiff_t>(offset),
                    [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; });
}

std::uint32_t big_endian(Bytes bytes, std::size_t offset, std::size_t size) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < size; ++i) value = value << 8U | bytes[offset + i];
  return value;
}

std::uint32_t little_endian(Bytes bytes, std::size_t offset, std::size_t size) {
  std::uint32_t value = 0;
  for (std::size_t i = size; i > 0; --i) value = value << 8U | bytes[offset + i - 1];
  return value;
}

/// A side as headers hold it, cut off at 2^30.
int side(std::uint32_t pixels) {
  return static_cast<int>(std::min(1U << 30U, pixels));
}

Orientation orientation_of(int exif) {
  // TIFF's eight: as the first row and column of the stored picture are to be seen.
  constexpr std::array<Orientation, 9> table{{{0, false},
                                              {0, false},
                                              {0, true},
                                              {180, false},
                                              {180, true},
                                              {270, true},
                                              {90, false},
                                              {90, true},
                                              {270, false}}};
  return table[static_cast<std::size_t>(exif)];
}

void take_exif(Bytes tiff, ImageFacts& facts) {
  const ExifFacts exif = read_exif(tiff);
  facts.orientation = orientation_of(exif.orientation);
  facts.is_adobe_rgb = exif.is_adobe_rgb;
  facts.focal_35mm = exif.focal_35mm;
}

ImageKind kind_of(Bytes bytes) {
  if (starts_with(bytes, "\xff\xd8\xff")) return ImageKind::jpeg;
  if (starts_with(bytes, "\x89PNG\r\n\x1a\n")) return ImageKind::png;
  if (starts_with(bytes, "BM")) return ImageKind::bmp;
  if (starts_with(bytes, "GIF8")) return ImageKind::gif;
  if (starts_with(bytes, "RIFF") && starts_with(bytes, "WEBP", 8)) return ImageKind::webp;
  if (starts_with(bytes, "\xff\x0a") || starts_with(bytes, "JXL ", 4)) return ImageKind::jpeg_xl;
  if (starts_with(bytes, "FUJIFILMCCD-RAW")) return ImageKind::raw;
  if (starts_with(bytes, "ftyp", 4)) {
    for (const char* brand : {"heic", "heix", "heim", "heis", "hevc", "mif1", "msf1"}) {
      if (starts_with(bytes, brand, 8)) return ImageKind::heif;
    }
    if (starts_with(bytes, "avif", 8) || starts_with(bytes, "avis", 8)) return ImageKind::avif;
    if (starts_with(bytes, "crx ", 8)) return ImageKind::raw;
    return ImageKind::unknown;
  }
  if (starts_with(bytes, std::string_view("II+\0", 4)) ||
      starts_with(bytes, std::string_view("MM\0+", 4))) {
    return ImageKind::big_tiff;
  }
  const bool is_tiff = starts_with(bytes, std::string_view("II*\0", 4)) ||
                       starts_with(bytes, std::string_view("MM\0*", 4));
  if (is_tiff && starts_with(bytes, "CR", 8)) return ImageKind::raw;
  return is_tiff ? ImageKind::tiff : ImageKind::unknown;
}

/// Walks the segments before the picture itself.
void read_jpeg(Bytes bytes, ImageFacts& facts) {
  std::map<int, Bytes> profile_parts;
  std::size_t at = 2;
  while (at + 4 <= bytes.size()) {
    const std::uint8_t marker = bytes[at + 1];
    if (bytes[at] != 0xff || marker == 0xff || marker == 0) {  // passed over by decoders, too
      ++at;
      continue;
    }
    if (marker == 0xda || marker == 0xd9) break;
    if (marker == 0x01 || (marker >= 0xd0 && marker <= 0xd8)) {
      at += 2;
      continue;
    }
    const std::size_t length = big_endian(bytes, at + 2, 2);
    if (length < 2 || length + 2 > bytes.size() - at) break;
    const Bytes segment = bytes.subspan(at + 4, length - 2);
    const bool is_frame =
        marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (is_frame && segment.size() >= 6) {
      facts.size = ImageSize{static_cast<int>(big_endian(segment, 3, 2)),
                             static_cast<int>(big_endian(segment, 1, 2))};
      facts.channels = segment[5];
    }
    constexpr std::string_view exif("Exif\0\0", 6), icc("ICC_PROFILE\0", 12);
    if (marker == 0xe1 && starts_with(segment, exif)) take_exif(segment.subspan(6), facts);
    if (marker == 0xe2 && starts_with(segment, icc) && segment.size() > 14) {
      profile_parts[segment[12]] = segment.subspan(14);
    }
    at += 2 + length;
  }
  for (const auto& [number, part] : profile_parts) {
    facts.profile.insert(facts.profile.end(), part.begin(), part.end());
  }
}

/// Behind the profile's name and a zero: zlib data.
std::vector<std::uint8_t> inflated_profile(Bytes chunk) {
  const auto zero = std::find(chunk.begin(), chunk.end(), std::uint8_t{0});
  if (chunk.end() - zero < 3) return {};
  const Bytes packed = chunk.subspan(static_cast<std::size_t>(zero - chunk.begin()) + 2);
  std::vector<std::uint8_t> profile(std::min(kMostProfile, 64 * packed.size() + 1024));
  uLongf size = profile.size();
  if (uncompress(profile.data(), &size, packed.data(), packed.size()) != Z_OK) return {};
  profile.resize(size);
  return profile;
}

/// Primaries, transfer, matrix, range of cICP, by the numbers of H.273; empty for sRGB.
std::string coding_doubt(Bytes chunk) {
  std::string doubt;
  const auto add = [&doubt](const std::string& part) {
    doubt += (doubt.empty() ? "" : ", ") + part;
  };
  const int primaries = chunk[0], transfer = chunk[1];
  constexpr int bt709 = 1, bt2020 = 9, dci_p3 = 11, display_p3 = 12, pq = 16, hlg = 18;
  if (primaries == bt2020) add("primaries BT.2020");
  if (primaries == dci_p3 || primaries == display_p3) add("primaries P3");
  if (primaries != bt709 && doubt.empty()) add("primaries " + std::to_string(primaries));
  if (transfer == pq) add("transfer PQ");
  if (transfer == hlg) add("transfer HLG");
  if (chunk[3] == 0) add("limited range");
  return doubt.empty() ? doubt : doubt + " (cICP)";
}

/// White, red, green, blue of cHRM: x and y of each in steps of 1e-5; empty for those of sRGB.
std::string primaries_doubt(Bytes chunk) {
  constexpr std::array<double, 8> srgb{0.3127, 0.3290, 0.64, 0.33, 0.30, 0.60, 0.15, 0.06};
  constexpr double same = 0.01;
  for (std::size_t i = 0; i < srgb.size(); ++i) {
    if (std::abs(big_endian(chunk, 4 * i, 4) / 1e5 - srgb[i]) > same) {
      return "other primaries than sRGB's (cHRM)";
    }
  }
  return {};
}

void read_png(Bytes bytes, ImageFacts& facts) {
  bool says_srgb = false, says_coding = false;
  std::size_t at = 8;
  while (at + 12 <= bytes.size()) {
    const std::size_t length = big_endian(bytes, at, 4);
    if (length > bytes.size() - at - 12) break;
    const Bytes chunk = bytes.subspan(at + 8, length);
    if (starts_with(bytes, "IDAT", at + 4)) break;
    if (starts_with(bytes, "IHDR", at + 4) && length >= 8) {
      facts.size = ImageSize{side(big_endian(chunk, 0, 4)), side(big_endian(chunk, 4, 4))};
      if (length > 8) facts.bits = chunk[8];
    }
    if (starts_with(bytes, "eXIf", at + 4)) take_exif(chunk, facts);
    if (starts_with(bytes, "iCCP", at + 4)) facts.profile = inflated_profile(chunk);
    if (starts_with(bytes, "sRGB", at + 4)) says_srgb = true;
    if (starts_with(bytes, "gAMA", at + 4) && length == 4) {
      facts.gamma = big_endian(chunk, 0, 4) / 100000.0;
    }
    if (starts_with(bytes, "cICP", at + 4) && length == 4) {
      facts.colour_doubt = coding_doubt(chunk);
      says_coding = true;
    }
    if (starts_with(bytes, "cHRM", at + 4) && length == 32 && !says_coding) {
      facts.colour_doubt = primaries_doubt(chunk);
    }
    at += 12 + length;
  }
  // cICP comes before sRGB, and that before cHRM and gAMA.
  if (says_srgb && !says_coding) facts.colour_doubt.clear();
  if (says_srgb || says_coding || !facts.profile.empty()) facts.gamma.reset();
}

/// Two numbers behind the length of the header; of the newer one the height is negative where the
/// first row is the upper one.
void read_bmp(Bytes bytes, ImageFacts& facts) {
  constexpr std::size_t header = 14, old_length = 12;
  if (bytes.size() < header + old_length) return;
  if (little_endian(bytes, header, 4) == old_length) {
    facts.size = ImageSize{side(little_endian(bytes, header + 4, 2)),
                           side(little_endian(bytes, header + 6, 2))};
    return;
  }
  const std::uint32_t height = little_endian(bytes, header + 8, 4);
  facts.size = ImageSize{side(little_endian(bytes, header + 4, 4)),
                         side(height >> 31U != 0 ? 0 - height : height)};
}

void read_webp(Bytes bytes, ImageFacts& facts) {
  std::size_t at = 12;
  while (at + 8 <= bytes.size()) {
    const std::size_t length = bytes[at + 4] | std::size_t{bytes[at + 5]} << 8U |
                               std::size_t{bytes[at + 6]} << 16U |
                               std::size_t{bytes[at + 7]} << 24U;
    if (length > bytes.size() - at - 8) break;
    const Bytes chunk = bytes.subspan(at + 8, length);
    if (starts_with(bytes, "VP8X", at) && length >= 10) {
      facts.size =
          ImageSize{side(little_endian(chunk, 4, 3) + 1), side(little_endian(chunk, 7, 3) + 1)};
    }
    if (starts_with(bytes, "ICCP", at)) facts.profile.assign(chunk.begin(), chunk.end());
    if (starts_with(bytes, "EXIF", at)) {
      constexpr std::string_view exif("Exif\0\0", 6);
      take_exif(starts_with(chunk, exif) ? chunk.subspan(6) : chunk, facts);
    }
    at += 8 + length + length % 2;
  }
}

}  // namespace

ImageFacts read_image_facts(Bytes bytes) {
  ImageFacts facts;
  facts.kind = kind_of(bytes);
  switch (facts.kind) {
    case ImageKind::jpeg:
      read_jpeg(bytes, facts);
      break;
    case ImageKind::png:
      read_png(bytes, facts);
      break;
    case ImageKind::webp:
      read_webp(bytes, facts);
      break;
    case ImageKind::bmp:
      read_bmp(bytes, facts);
      break;
    case ImageKind::tiff: {
      take_exif(bytes, facts);
      facts.size = tiff_size(bytes);
      facts.colour_fault = tiff_colour_fault(bytes);
      facts.bits = tiff_bits(bytes);
      const auto profile = tiff_profile(bytes);
      facts.profile.assign(profile.begin(), profile.end());
      break;
    }
    default:
      break;
  }
  if (facts.profile.size() > kMostProfile) facts.profile.clear();
  return facts;
}

std::optional<UnreadableKind> unreadable_kind(ImageKind kind) {
  switch (kind) {
    case ImageKind::heif:
      return UnreadableKind{"HEIC",
                            "convert it to JPEG, for instance by heif-convert -q 95, or let the "
                            "phone take JPEG"};
    case ImageKind::avif:
      return UnreadableKind{"AVIF", "convert it to JPEG or PNG"};
    case ImageKind::jpeg_xl:
      return UnreadableKind{"JPEG XL", "convert it to JPEG or PNG"};
    case ImageKind::gif:
      return UnreadableKind{"GIF", "convert it to PNG"};
    case ImageKind::big_tiff:
      return UnreadableKind{"BigTIFF", "write it as an ordinary TIFF or PNG"};
    case ImageKind::raw:
      return UnreadableKind{"a camera's raw format",
                            "develop it to JPEG or PNG, without lens correction"};
    default:
      return std::nullopt;
  }
}

std::optional<UnreadableKind> unreadable_ending(const std::filesystem::path& path) {
  const std::string ending = core::lower_case(path.extension().string());
  const auto is_one_of = [&ending](std::initializer_list<const char*> endings) {
    return std::find(endings.begin(), endings.end(), ending) != endings.end();
  };
  if (is_one_of({".heic", ".heif", ".hif"})) return unreadable_kind(ImageKind::heif);
  if (is_one_of({".avif"})) return unreadable_kind(ImageKind::avif);
  if (is_one_of({".jxl"})) return unreadable_kind(ImageKind::jpeg_xl);
  if (is_one_of({".gif"})) return unreadable_kind(ImageKind::gif);
  if (is_one_of({".dng", ".cr2", ".cr3", ".nef", ".arw", ".raf", ".rw2", ".orf", ".pef", ".srw"})) {
    return unreadable_kind(ImageKind::raw);
  }
  return std::nullopt;
}

}  // namespace sheen::capture
