// SPDX-License-Identifier: MIT
#pragma once

#include "core/diagnostics/error.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>

namespace sheen::capture {

static_assert(std::endian::native == std::endian::little, "COLMAP's files are little-endian");

[[noreturn]] inline void refuse_colmap(const std::filesystem::path& path,
                                       const std::string& fault) {
  throw core::bad_input(path, fault, "write the model again with COLMAP's model_converter");
}

/// Takes values off the front of the bytes of a binary file; nothing beyond them is ever read.
class ColmapReader {
 public:
  ColmapReader(const std::filesystem::path& path, std::string_view bytes)
      : path_(path), bytes_(bytes) {}

  template <typename Value>
  Value take() {
    static_assert(std::is_arithmetic_v<Value>);
    Value value{};
    check(sizeof value);
    std::memcpy(&value, bytes_.data(), sizeof value);
    bytes_.remove_prefix(sizeof value);
    return value;
  }

  /// A count of things that take `least_bytes` each; refused when the file is too short for them.
  std::uint64_t count(std::size_t least_bytes) {
    const auto number = take<std::uint64_t>();
    if (number > bytes_.size() / least_bytes) refuse_colmap(path_, "is shorter than it says");
    return number;
  }

  /// Up to the next zero byte.
  std::string name() {
    const std::size_t end = bytes_.find('\0');
    if (end == std::string_view::npos) refuse_colmap(path_, "ends within the name of an image");
    const std::string text(bytes_.substr(0, end));
    bytes_.remove_prefix(end + 1);
    return text;
  }

  void skip(std::size_t byte_count) {
    check(byte_count);
    bytes_.remove_prefix(byte_count);
  }

 private:
  void check(std::size_t byte_count) const {
    if (byte_count > bytes_.size()) refuse_colmap(path_, "is cut short");
  }

  const std::filesystem::path& path_;
  std::string_view bytes_;
};

template <typename Value>
void put_bytes(std::string& bytes, const Value& value) {
  static_assert(std::is_arithmetic_v<Value>);
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

}  // namespace sheen::capture
