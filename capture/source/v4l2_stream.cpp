// SPDX-License-Identifier: MIT
#include "capture/source/v4l2_stream.h"

#include <linux/videodev2.h>

#include <cerrno>
#include <utility>

namespace sheen::capture {
namespace {

/// At 60 images a second a reader may be late by a tenth of a second.
constexpr __u32 wanted_buffers = 8;
/// One with the caller, one that is being filled.
constexpr __u32 fewest_buffers = 2;
constexpr __u32 most_buffers = 32;

v4l2_buffer mapped_buffer(__u32 index) {
  v4l2_buffer buffer{};
  buffer.index = index;
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.memory = V4L2_MEMORY_MMAP;
  return buffer;
}

v4l2_requestbuffers buffer_request(__u32 count) {
  v4l2_requestbuffers request{};
  request.count = count;
  request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  request.memory = V4L2_MEMORY_MMAP;
  return request;
}

/// Zero, which no image has, for a time that no machine has run.
std::chrono::nanoseconds duration(const timeval& time) {
  constexpr time_t century_s = 3'155'760'000;
  if (time.tv_sec < 0 || time.tv_sec > century_s || time.tv_usec < 0 || time.tv_usec >= 1'000'000)
    return std::chrono::nanoseconds(0);
  return std::chrono::seconds(time.tv_sec) + std::chrono::microseconds(time.tv_usec);
}

}  // namespace

V4l2Mapping::V4l2Mapping(const V4l2Device& device, std::size_t length, std::int64_t offset)
    : system_(&device.system()) {
  void* address = system_->map(device.descriptor(), length, offset);
  if (address == nullptr) throw device_fault(device.node(), "mapping its memory", errno);
  bytes_ = {static_cast<std::uint8_t*>(address), length};
}

V4l2Mapping::~V4l2Mapping() {
  if (!bytes_.empty()) system_->unmap(bytes_.data(), bytes_.size());
}

V4l2Mapping::V4l2Mapping(V4l2Mapping&& other) noexcept
    : system_(other.system_), bytes_(std::exchange(other.bytes_, {})) {}

V4l2Stream::V4l2Stream(const V4l2Device& device, const ActiveMode& mode)
    : device_(device), mode_(mode) {
  try {
    map_buffers();
    for (__u32 index = 0; index < mappings_.size(); ++index) queue(index);
    int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    device_.require(VIDIOC_STREAMON, &type, "starting the stream");
  } catch (...) {
    give_back();
    throw;
  }
}

V4l2Stream::~V4l2Stream() {
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  // The device may be gone already: nothing can be done about a failure here.
  static_cast<void>(device_.request(VIDIOC_STREAMOFF, &type));
  give_back();
}

void V4l2Stream::map_buffers() {
  v4l2_requestbuffers request = buffer_request(wanted_buffers);
  device_.require(VIDIOC_REQBUFS, &request, "reserving memory for images");
  if (request.count < fewest_buffers || request.count > most_buffers)
    throw device_fault(device_.node(), "reserving memory for images", ENOMEM);

  for (__u32 index = 0; index < request.count; ++index) {
    v4l2_buffer buffer = mapped_buffer(index);
    device_.require(VIDIOC_QUERYBUF, &buffer, "asking for its memory");
    if (buffer.length == 0 || buffer.length < mode_.least_bytes)
      throw device_fault(device_.node(), "reserving memory for whole images", ENOMEM);
    mappings_.emplace_back(device_, buffer.length, buffer.m.offset);
  }
}

void V4l2Stream::queue(std::uint32_t index) {
  v4l2_buffer buffer = mapped_buffer(index);
  device_.require(VIDIOC_QBUF, &buffer, "giving it memory for an image");
}

bool V4l2Stream::whole(std::span<const std::uint8_t> bytes) const {
  if (mode_.mode.format != PixelFormat::mjpeg) return bytes.size() >= mode_.least_bytes;
  // Every JPEG file starts with the marker SOI.
  return bytes.size() > 4 && bytes[0] == 0xff && bytes[1] == 0xd8;
}

void V4l2Stream::give_back() noexcept {
  mappings_.clear();
  v4l2_requestbuffers none = buffer_request(0);
  static_cast<void>(device_.request(VIDIOC_REQBUFS, &none));
}

std::optional<V4l2Image> V4l2Stream::next(std::chrono::milliseconds timeout) {
  if (held_) queue(*std::exchange(held_, std::nullopt));

  // Wait; a broken stream wakes the wait, too, and dequeuing says what is wrong.
  const int ready = device_.system().poll(device_.descriptor(), timeout);
  if (ready < 0) throw device_fault(device_.node(), "waiting for an image", errno);
  if (ready == 0) return std::nullopt;

  v4l2_buffer buffer = mapped_buffer(0);
  const int fault = device_.request(VIDIOC_DQBUF, &buffer);
  if (fault == EAGAIN) {
    // Woken for nothing: do not spin.
    device_.system().pause(std::chrono::milliseconds(1));
    return std::nullopt;
  }
  if (fault != 0) throw device_fault(device_.node(), "taking an image", fault);
  if (buffer.index >= mappings_.size())
    throw device_fault(device_.node(), "taking an image", EBADSLT);
  held_ = buffer.index;
  if (std::exchange(first_is_stale_, false)) return std::nullopt;

  // Look at what came.
  const auto memory = mappings_[buffer.index].bytes();
  const bool fits = buffer.bytesused <= memory.size();
  V4l2Image image;
  image.bytes = fits ? memory.first(buffer.bytesused) : memory.first(0);
  image.sequence = buffer.sequence;
  image.stamp = duration(buffer.timestamp);
  image.damaged = (buffer.flags & V4L2_BUF_FLAG_ERROR) != 0 || !whole(image.bytes);
  return image;
}

}  // namespace sheen::capture
