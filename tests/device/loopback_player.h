// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/camera.h"
#include "capture/source/frame_range.h"

#include <cstdint>
#include <string>
#include <thread>
#include <vector>

namespace sheen::capture::test {

/// Images as a camera would send them.
struct Recording {
  PixelFormat format = PixelFormat::mjpeg;
  ImageSize size;
  double fps = 30;
  std::vector<std::vector<std::uint8_t>> images;  ///< at least one
};

/// The sample session's video, its compressed images as they lie in the file.
[[nodiscard]] Recording sample_recording();

/// Plays a recording into the writing end of a v4l2loopback device, over and over at its rate,
/// until it goes out of scope.
class LoopbackPlayer {
 public:
  /// Throws core::Error when the device does not take the format.
  LoopbackPlayer(const std::string& node, Recording recording);
  ~LoopbackPlayer();
  LoopbackPlayer(const LoopbackPlayer&) = delete;
  LoopbackPlayer& operator=(const LoopbackPlayer&) = delete;
  LoopbackPlayer(LoopbackPlayer&&) = delete;
  LoopbackPlayer& operator=(LoopbackPlayer&&) = delete;

 private:
  void write(std::size_t index);
  void play(const std::stop_token& stop);

  std::string node_;
  Recording recording_;
  int descriptor_;
  std::jthread thread_;
};

}  // namespace sheen::capture::test
