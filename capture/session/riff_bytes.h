// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

namespace sheen::capture {

/// Little-endian bytes of a RIFF file, and chunks whose sizes are known only after they are filled.
class RiffBytes {
 public:
  void text(std::string_view four_letters) {
    for (const char letter : four_letters) bytes_.push_back(static_cast<std::uint8_t>(letter));
  }
  void u16(std::uint32_t value) { put(value, 2); }
  void u32(std::uint32_t value) { put(value, 4); }
  void u64(std::uint64_t value) { put(value, 8); }
  void zeros(std::size_t words) { bytes_.insert(bytes_.end(), words * 4, 0); }

  /// Starts a chunk; returns where its data begins.
  std::size_t open(std::string_view name) {
    text(name);
    u32(0);
    return bytes_.size();
  }
  void close(std::size_t begin) {
    const std::size_t size = bytes_.size() - begin;
    for (std::size_t i = 0; i < 4; ++i) {
      bytes_[begin - 4 + i] = static_cast<std::uint8_t>(size >> (8 * i));
    }
  }
  [[nodiscard]] std::size_t size() const { return bytes_.size(); }
  std::vector<std::uint8_t> take() { return std::move(bytes_); }

 private:
  void put(std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) bytes_.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
  }

  std::vector<std::uint8_t> bytes_;
};

}  // namespace sheen::capture
