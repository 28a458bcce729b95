// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace sheen::capture {

/// The system calls that a V4L2 camera is driven by, with their own meaning: -1 or a null pointer
/// on failure, and errno says why. An interface, so that every fault can be played without a
/// device.
class V4l2System {
 public:
  virtual ~V4l2System() = default;

  /// For reading and writing, without blocking. Returns a file descriptor.
  virtual int open(const std::filesystem::path& node) = 0;
  virtual int close(int descriptor) = 0;
  virtual int ioctl(int descriptor, unsigned long request, void* argument) = 0;
  /// Shared, readable memory; null on failure.
  virtual void* map(int descriptor, std::size_t length, std::int64_t offset) = 0;
  virtual int unmap(void* address, std::size_t length) = 0;
  /// Waits for an image: 0 after `timeout`, 1 when there is one or the stream is broken.
  virtual int poll(int descriptor, std::chrono::milliseconds timeout) = 0;

  /// /dev/video*, in the order of their numbers.
  [[nodiscard]] virtual std::vector<std::filesystem::path> video_nodes() const = 0;
  /// The kernel's monotonic clock, which also stamps the images.
  [[nodiscard]] virtual std::chrono::nanoseconds now() const = 0;
  virtual void pause(std::chrono::milliseconds duration) = 0;
};

/// The kernel of this machine.
[[nodiscard]] V4l2System& kernel_v4l2_system();

}  // namespace sheen::capture
