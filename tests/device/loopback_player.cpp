// SPDX-License-Identifier: MIT
#include "tests/device/loopback_player.h"

#include "capture/source/avi_reader.h"
#include "capture/source/v4l2_device.h"
#include "capture/source/v4l2_modes.h"

#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <utility>

namespace sheen::capture::test {
namespace {

void set_output(int descriptor, const std::string& node, const Recording& recording) {
  // The driver finds out whether it is a camera or a screen when it is asked.
  v4l2_capability capability{};
  if (::ioctl(descriptor, VIDIOC_QUERYCAP, &capability) == -1)
    throw device_fault(node, "asking what it can do", errno);
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
  v4l2_pix_format& pix = format.fmt.pix;
  pix.width = static_cast<__u32>(recording.size.width_px);
  pix.height = static_cast<__u32>(recording.size.height_px);
  pix.pixelformat = fourcc(recording.format);
  pix.field = V4L2_FIELD_NONE;
  pix.sizeimage = pix.width * pix.height * 2;
  pix.bytesperline = recording.format == PixelFormat::yuyv ? pix.width * 2 : 0;
  pix.colorspace = V4L2_COLORSPACE_SRGB;
  if (::ioctl(descriptor, VIDIOC_S_FMT, &format) == -1)
    throw device_fault(node, "setting the format to be played", errno);
  v4l2_streamparm rate{};
  rate.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
  rate.parm.output.timeperframe = {1, static_cast<__u32>(std::lround(recording.fps))};
  if (::ioctl(descriptor, VIDIOC_S_PARM, &rate) == -1)
    throw device_fault(node, "setting the rate to be played", errno);
  // Writing needs no stream, but without one the driver forgets to be free again afterwards.
  int type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
  if (::ioctl(descriptor, VIDIOC_STREAMON, &type) == -1)
    throw device_fault(node, "starting to play", errno);
}

}  // namespace

Recording sample_recording() {
  const std::string path = SHEEN_SOURCE_DIR "/sample_data/glossy/frames.avi";
  auto reader = AviReader::open(path);
  if (!reader || reader->header().codec != "MJPG")
    throw core::bad_input(path, "this is no MJPEG video", "restore it");
  Recording recording;
  recording.size = reader->header().size;
  recording.fps = reader->header().fps;
  while (reader->advance()) {
    const auto bytes = reader->read();
    recording.images.emplace_back(bytes.begin(), bytes.end());
  }
  return recording;
}

LoopbackPlayer::LoopbackPlayer(const std::string& node, Recording recording)
    : node_(node),
      recording_(std::move(recording)),
      descriptor_(::open(node.c_str(), O_RDWR | O_CLOEXEC)) {
  if (descriptor_ == -1) throw device_fault(node_, "opening", errno);
  try {
    set_output(descriptor_, node_, recording_);
    // With its first image the device becomes a camera.
    write(0);
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
  thread_ = std::jthread([this](const std::stop_token& stop) { play(stop); });
}

LoopbackPlayer::~LoopbackPlayer() {
  thread_.request_stop();
  thread_.join();
  ::close(descriptor_);
}

void LoopbackPlayer::write(std::size_t index) {
  const auto& image = recording_.images[index];
  if (::write(descriptor_, image.data(), image.size()) != static_cast<ssize_t>(image.size()))
    throw device_fault(node_, "writing an image", errno);
}

void LoopbackPlayer::play(const std::stop_token& stop) {
  const auto period = std::chrono::duration_cast<std::chrono::steady_clock::duration>(
      std::chrono::duration<double>(1 / recording_.fps));
  auto due = std::chrono::steady_clock::now();
  for (std::size_t index = 1; !stop.stop_requested(); ++index) {
    due += period;
    std::this_thread::sleep_until(due);
    write(index % recording_.images.size());
  }
}

}  // namespace sheen::capture::test
