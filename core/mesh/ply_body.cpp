// SPDX-License-Identifier: MIT
#include "core/mesh/ply_body.h"

#include "core/text/number.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace sheen::core {

static_assert(std::endian::native == std::endian::little, "bytes are read as they lie");

template <typename T>
T PlyBody::next_binary() {
  if (rest_.size() < sizeof(T)) throw broken("is cut short");
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), rest_.data(), sizeof(T));
  if (format_ == PlyFormat::big_endian) std::reverse(raw.begin(), raw.end());
  rest_.remove_prefix(sizeof(T));
  return std::bit_cast<T>(raw);
}

double PlyBody::next_word() {
  constexpr std::string_view space = " \t\r\n";
  const std::size_t begin = rest_.find_first_not_of(space);
  if (begin == std::string_view::npos) throw broken("is cut short");
  rest_.remove_prefix(begin);
  const std::string_view word = rest_.substr(0, rest_.find_first_of(space));
  const auto value = parse_number(word);
  if (!value) {
    throw broken("holds a word that is not a number (" + why_no_number(word) + ")");
  }
  rest_.remove_prefix(word.size());
  return *value;
}

double PlyBody::next(PlyScalar type) {
  if (format_ == PlyFormat::ascii) return next_word();
  switch (type) {
    case PlyScalar::int8:
      return next_binary<std::int8_t>();
    case PlyScalar::uint8:
      return next_binary<std::uint8_t>();
    case PlyScalar::int16:
      return next_binary<std::int16_t>();
    case PlyScalar::uint16:
      return next_binary<std::uint16_t>();
    case PlyScalar::int32:
      return next_binary<std::int32_t>();
    case PlyScalar::uint32:
      return next_binary<std::uint32_t>();
    case PlyScalar::float32:
      return static_cast<double>(next_binary<float>());
    case PlyScalar::float64:
      return next_binary<double>();
  }
  throw broken("names a type that does not exist");
}

std::size_t PlyBody::next_integer(PlyScalar type, std::size_t end, const char* fault) {
  const double value = next(type);
  if (!(value >= 0 && value < static_cast<double>(end)) || value != std::floor(value)) {
    throw broken(fault);
  }
  return static_cast<std::size_t>(value);
}

std::size_t PlyBody::next_index(PlyScalar type, std::size_t end) {
  return next_integer(type, end, "has a face with a corner that does not exist");
}

std::size_t PlyBody::next_length(PlyScalar type) {
  return next_integer(type, rest_.size() + 1, "is cut short or holds a list of impossible length");
}

void PlyBody::skip_list(const PlyProperty& property) {
  const std::size_t length = next_length(*property.count);
  for (std::size_t i = 0; i < length; ++i) next(property.type);
}

void PlyBody::skip_row(const PlyElement& element) {
  for (const PlyProperty& property : element.properties) {
    if (property.count) {
      skip_list(property);
    } else {
      next(property.type);
    }
  }
}

}  // namespace sheen::core
