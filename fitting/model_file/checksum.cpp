// SPDX-License-Identifier: MIT
#include "fitting/model_file/checksum.h"

#include <cassert>
#include <cstdint>
#include <string_view>

namespace sheen::fitting {
namespace {

constexpr std::string_view kPrefix = "fnv1a64:";
constexpr std::size_t kDigits = 16;

std::string fnv1a64(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char byte : bytes) {
    hash ^= static_cast<unsigned char>(byte);
    hash *= 0x100000001b3U;
  }
  std::string digits(kDigits, '0');
  for (std::size_t i = kDigits; i-- > 0; hash >>= 4) digits[i] = "0123456789abcdef"[hash & 15];
  return digits;
}

}  // namespace

void write_checksum(std::string& file) {
  const std::size_t place = file.find(kChecksumPlaceholder);
  assert(place != std::string::npos);
  file.replace(place + kPrefix.size(), kDigits, fnv1a64(file));
}

bool has_valid_checksum(std::string file) {
  const std::size_t place = file.find(kPrefix);
  if (place == std::string::npos || file.size() - place < kPrefix.size() + kDigits) return false;
  const std::string digits = file.substr(place + kPrefix.size(), kDigits);
  file.replace(place + kPrefix.size(), kDigits, kDigits, '0');
  return digits == fnv1a64(file);
}

}  // namespace sheen::fitting
