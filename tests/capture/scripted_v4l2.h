// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/v4l2_camera.h"
#include "capture/source/v4l2_system.h"

#include <linux/videodev2.h>

#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace sheen::capture::test {

/// One camera as a kernel shows it, with faults on demand and a clock of its own that only moves
/// while somebody waits. It keeps the books: `violations` counts everything that a driver would
/// resent, such as giving the same memory back twice.
class ScriptedV4l2 : public V4l2System {
 public:
  struct Mode {
    std::uint32_t fourcc;
    std::uint32_t width;
    std::uint32_t height;
    std::vector<v4l2_fract> intervals;
  };
  struct Control {
    std::uint32_t id;
    std::string name;
    int minimum;
    int maximum;
    int value;
    std::uint32_t type = V4L2_CTRL_TYPE_INTEGER;
  };
  /// One image before it is handed over, for a script to spoil.
  struct Image {
    std::uint32_t count;  ///< since the device was plugged in; its first four bytes after the mark
    std::uint32_t sequence;  ///< = count
    std::chrono::nanoseconds stamp;
    std::uint32_t flags = 0;
    std::vector<std::uint8_t> bytes;
    std::uint32_t bytes_used = 0;  ///< = bytes.size()
    bool dropped = false;          ///< the driver had no use for it
  };

  ScriptedV4l2();

  /// What the camera is; may be changed at any time.
  std::filesystem::path node = "/dev/video0";
  std::string name = "Scripted Camera";
  std::string bus = "usb-1";
  std::uint32_t abilities = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  std::vector<Mode> modes;
  std::vector<Control> controls;
  std::chrono::nanoseconds period = std::chrono::milliseconds(20);
  std::uint32_t field = V4L2_FIELD_NONE;
  std::uint32_t driver_buffers = 8;  ///< the most that it lends
  bool silent = false;               ///< streams, but no image comes

  /// Looks at every image before it is handed over.
  std::function<void(Image&)> spoil;
  /// Called when the image of this count is due, before it is delivered.
  std::map<std::uint32_t, std::function<void()>> events;

  /// The next `times` requests of this code fail.
  void fail(unsigned long request, int code, int times = 1);
  void fail_poll(int code) { poll_fault_ = code; }
  /// All that is open answers ENODEV from now on, and the node is gone.
  void unplug();
  /// A device is there again: counts from 0, forgot its controls.
  void plug_in();

  int violations = 0;
  int starts = 0;  ///< times that a stream was started
  [[nodiscard]] std::size_t open_descriptors() const { return open_.size(); }
  [[nodiscard]] std::size_t mapped() const { return mapped_.size(); }
  [[nodiscard]] int value_of(std::uint32_t control) const;
  [[nodiscard]] v4l2_pix_format format() const { return format_; }
  [[nodiscard]] double fps() const;

  int open(const std::filesystem::path& path) override;
  int close(int descriptor) override;
  int ioctl(int descriptor, unsigned long request, void* argument) override;
  void* map(int descriptor, std::size_t length, std::int64_t offset) override;
  int unmap(void* address, std::size_t length) override;
  int poll(int descriptor, std::chrono::milliseconds timeout) override;
  [[nodiscard]] std::vector<std::filesystem::path> video_nodes() const override;
  [[nodiscard]] std::chrono::nanoseconds now() const override { return now_; }
  void pause(std::chrono::milliseconds duration) override;

 private:
  struct Fault {
    int code;
    int times;
  };
  struct Buffer {
    std::vector<std::uint8_t> memory;
    bool queued = false;
  };

  int answer(unsigned long request, void* argument);
  int describe(v4l2_capability& capability) const;
  int enumerate(v4l2_fmtdesc& entry) const;
  int enumerate(v4l2_frmsizeenum& entry) const;
  int enumerate(v4l2_frmivalenum& entry) const;
  int set(v4l2_format& format);
  int set(v4l2_streamparm& parameters);
  int reserve(v4l2_requestbuffers& request);
  int query(v4l2_buffer& buffer) const;
  int queue(const v4l2_buffer& buffer);
  int dequeue(v4l2_buffer& buffer);
  int stream_on();
  int stream_off();
  int query(v4l2_queryctrl& entry) const;
  int get(v4l2_control& control) const;
  int set(const v4l2_control& control);
  void expose();
  [[nodiscard]] Image next_image() const;

  std::chrono::nanoseconds now_{std::chrono::seconds(1000)};
  std::chrono::nanoseconds due_{};
  std::map<unsigned long, Fault> faults_;
  int poll_fault_ = 0;
  bool plugged_ = true;
  std::map<int, bool> open_;  ///< descriptor -> its device is still there
  int next_descriptor_ = 100;
  std::map<void*, std::size_t> mapped_;
  std::vector<Buffer> buffers_;
  std::deque<int> waiting_;  ///< queued, in order
  std::deque<v4l2_buffer> done_;
  v4l2_pix_format format_{};
  v4l2_fract interval_{1, 50};
  std::vector<Control> initial_controls_;
  bool streaming_ = false;
  std::uint32_t count_ = 0;
};

/// The count that an image carries: in its first four bytes, for MJPEG after the mark SOI.
[[nodiscard]] std::uint32_t image_count(const std::uint8_t* bytes, bool jpeg);

/// Starts at once, so that the first image of the stream is the first one dropped.
inline V4l2CameraOptions at_once() {
  V4l2CameraOptions options;
  options.lock_automatics = false;
  return options;
}

}  // namespace sheen::capture::test
