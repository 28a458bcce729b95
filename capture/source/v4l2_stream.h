// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/v4l2_device.h"
#include "capture/source/v4l2_modes.h"

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace sheen::capture {

/// Memory of a driver, mapped. Move-only owner.
class V4l2Mapping {
 public:
  /// Throws V4l2Error.
  V4l2Mapping(const V4l2Device& device, std::size_t length, std::int64_t offset);
  ~V4l2Mapping();
  V4l2Mapping(V4l2Mapping&& other) noexcept;
  V4l2Mapping& operator=(V4l2Mapping&& other) = delete;
  V4l2Mapping(const V4l2Mapping&) = delete;
  V4l2Mapping& operator=(const V4l2Mapping&) = delete;

  [[nodiscard]] std::span<const std::uint8_t> bytes() const { return bytes_; }

 private:
  V4l2System* system_;
  std::span<std::uint8_t> bytes_;
};

/// One image in the driver's memory.
struct V4l2Image {
  std::span<const std::uint8_t> bytes;  ///< valid until the next call
  std::uint32_t sequence = 0;           ///< the driver's count
  std::chrono::nanoseconds stamp{};     ///< as the driver says
  bool damaged = false;                 ///< marked so by the driver, or cut short
};

/// A running capture into mapped memory; stops with the object. The device must outlive it.
class V4l2Stream {
 public:
  /// Starts. Throws V4l2Error.
  V4l2Stream(const V4l2Device& device, const ActiveMode& mode);
  ~V4l2Stream();
  V4l2Stream(const V4l2Stream&) = delete;
  V4l2Stream& operator=(const V4l2Stream&) = delete;

  /// The next image but the first, which may be older than the stream; nothing when none came
  /// within `timeout`. Gives the memory of the previous one back. Throws V4l2Error when the stream
  /// is broken: then only the destructor may follow.
  [[nodiscard]] std::optional<V4l2Image> next(std::chrono::milliseconds timeout);

 private:
  void map_buffers();
  void queue(std::uint32_t index);
  [[nodiscard]] bool whole(std::span<const std::uint8_t> bytes) const;
  void give_back() noexcept;

  const V4l2Device& device_;
  ActiveMode mode_;
  std::vector<V4l2Mapping> mappings_;
  std::optional<std::uint32_t> held_;  ///< index of the image that the caller looks at
  bool first_is_stale_ = true;
};

}  // namespace sheen::capture
