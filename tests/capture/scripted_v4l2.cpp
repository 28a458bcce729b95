// SPDX-License-Identifier: MIT
#include "tests/capture/scripted_v4l2.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <utility>

namespace sheen::capture::test {
namespace {

template <std::size_t N>
void write_field(__u8 (&field)[N], const std::string& text) {
  std::memcpy(field, text.data(), std::min(text.size(), N));
}

bool is_jpeg(std::uint32_t fourcc) {
  return fourcc == V4L2_PIX_FMT_MJPEG;
}

}  // namespace

std::uint32_t image_count(const std::uint8_t* bytes, bool jpeg) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes + (jpeg ? 2 : 0), sizeof count);
  return count;
}

ScriptedV4l2::ScriptedV4l2() {
  modes = {{V4L2_PIX_FMT_YUYV, 64, 48, {{1, 50}, {1, 25}}}};
}

void ScriptedV4l2::fail(unsigned long request, int code, int times) {
  faults_[request] = {code, times};
}

void ScriptedV4l2::unplug() {
  plugged_ = false;
  for (auto& [descriptor, alive] : open_) alive = false;
}

void ScriptedV4l2::plug_in() {
  plugged_ = true;
  count_ = 0;
  streaming_ = false;
  if (!initial_controls_.empty()) controls = initial_controls_;
}

int ScriptedV4l2::value_of(std::uint32_t control) const {
  for (const Control& known : controls)
    if (known.id == control) return known.value;
  return -1;
}

double ScriptedV4l2::fps() const {
  return static_cast<double>(interval_.denominator) / static_cast<double>(interval_.numerator);
}

int ScriptedV4l2::open(const std::filesystem::path& path) {
  if (initial_controls_.empty()) initial_controls_ = controls;
  if (!plugged_ || path != node) {
    errno = ENOENT;
    return -1;
  }
  open_[next_descriptor_] = true;
  return next_descriptor_++;
}

int ScriptedV4l2::close(int descriptor) {
  if (open_.erase(descriptor) == 0) ++violations;
  // The kernel keeps a device's memory until the last mapping is gone, but a careful owner unmaps.
  if (!mapped_.empty()) ++violations;
  if (open_.empty()) {
    streaming_ = false;
    buffers_.clear();
    waiting_.clear();
    done_.clear();
  }
  return 0;
}

int ScriptedV4l2::ioctl(int descriptor, unsigned long request, void* argument) {
  const auto found = open_.find(descriptor);
  if (found == open_.end()) ++violations;
  int code = found == open_.end() ? EBADF : found->second ? 0 : ENODEV;
  const auto fault = faults_.find(request);
  if (code == 0 && fault != faults_.end() && fault->second.times > 0) {
    --fault->second.times;
    code = fault->second.code;
  }
  if (code == 0) code = answer(request, argument);
  errno = code;
  return code == 0 ? 0 : -1;
}

int ScriptedV4l2::answer(unsigned long request, void* argument) {
  switch (request) {
    case VIDIOC_QUERYCAP:
      return describe(*static_cast<v4l2_capability*>(argument));
    case VIDIOC_ENUM_FMT:
      return enumerate(*static_cast<v4l2_fmtdesc*>(argument));
    case VIDIOC_ENUM_FRAMESIZES:
      return enumerate(*static_cast<v4l2_frmsizeenum*>(argument));
    case VIDIOC_ENUM_FRAMEINTERVALS:
      return enumerate(*static_cast<v4l2_frmivalenum*>(argument));
    case VIDIOC_S_FMT:
      return set(*static_cast<v4l2_format*>(argument));
    case VIDIOC_G_PARM: {
      auto& capture = static_cast<v4l2_streamparm*>(argument)->parm.capture;
      capture.capability = V4L2_CAP_TIMEPERFRAME;
      capture.timeperframe = interval_;
      return 0;
    }
    case VIDIOC_S_PARM:
      return set(*static_cast<v4l2_streamparm*>(argument));
    case VIDIOC_REQBUFS:
      return reserve(*static_cast<v4l2_requestbuffers*>(argument));
    case VIDIOC_QUERYBUF:
      return query(*static_cast<v4l2_buffer*>(argument));
    case VIDIOC_QBUF:
      return queue(*static_cast<v4l2_buffer*>(argument));
    case VIDIOC_DQBUF:
      return dequeue(*static_cast<v4l2_buffer*>(argument));
    case VIDIOC_STREAMON:
      return stream_on();
    case VIDIOC_STREAMOFF:
      return stream_off();
    case VIDIOC_QUERYCTRL:
      return query(*static_cast<v4l2_queryctrl*>(argument));
    case VIDIOC_G_CTRL:
      return get(*static_cast<v4l2_control*>(argument));
    case VIDIOC_S_CTRL:
      return set(*static_cast<v4l2_control*>(argument));
    default:
      return ENOTTY;
  }
}

int ScriptedV4l2::describe(v4l2_capability& capability) const {
  write_field(capability.card, name);
  write_field(capability.bus_info, bus);
  // As drivers of several nodes do: together they can more than this one.
  capability.capabilities =
      abilities | V4L2_CAP_DEVICE_CAPS | V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  capability.device_caps = abilities;
  return 0;
}

int ScriptedV4l2::enumerate(v4l2_fmtdesc& entry) const {
  std::vector<std::uint32_t> formats;
  for (const Mode& mode : modes)
    if (std::find(formats.begin(), formats.end(), mode.fourcc) == formats.end())
      formats.push_back(mode.fourcc);
  if (entry.index >= formats.size()) return EINVAL;
  entry.pixelformat = formats[entry.index];
  return 0;
}

int ScriptedV4l2::enumerate(v4l2_frmsizeenum& entry) const {
  std::uint32_t index = 0;
  for (const Mode& mode : modes) {
    if (mode.fourcc != entry.pixel_format || index++ != entry.index) continue;
    entry.type = V4L2_FRMSIZE_TYPE_DISCRETE;
    entry.discrete = {mode.width, mode.height};
    return 0;
  }
  return EINVAL;
}

int ScriptedV4l2::enumerate(v4l2_frmivalenum& entry) const {
  for (const Mode& mode : modes) {
    if (mode.fourcc != entry.pixel_format || mode.width != entry.width ||
        mode.height != entry.height)
      continue;
    if (entry.index >= mode.intervals.size()) return EINVAL;
    entry.type = V4L2_FRMIVAL_TYPE_DISCRETE;
    entry.discrete = mode.intervals[entry.index];
    return 0;
  }
  return EINVAL;
}

int ScriptedV4l2::set(v4l2_format& format) {
  if (!buffers_.empty()) return EBUSY;
  // As a driver does: what is asked for, or the first mode.
  const v4l2_pix_format& asked = format.fmt.pix;
  const auto known = std::find_if(modes.begin(), modes.end(), [&](const Mode& mode) {
    return mode.fourcc == asked.pixelformat && mode.width == asked.width &&
           mode.height == asked.height;
  });
  const Mode& mode = known == modes.end() ? modes.front() : *known;
  format_ = {};
  format_.pixelformat = mode.fourcc;
  format_.width = mode.width;
  format_.height = mode.height;
  format_.field = field;
  format_.bytesperline = is_jpeg(mode.fourcc)               ? 0
                         : mode.fourcc == V4L2_PIX_FMT_YUYV ? 2 * mode.width
                                                            : mode.width;
  format_.sizeimage = 2 * mode.width * mode.height;
  format.fmt.pix = format_;
  return 0;
}

int ScriptedV4l2::set(v4l2_streamparm& parameters) {
  // The nearest of the mode's intervals, as the kernel's drivers do it.
  const v4l2_fract asked = parameters.parm.capture.timeperframe;
  const auto seconds = [](const v4l2_fract& interval) {
    return static_cast<double>(interval.numerator) / static_cast<double>(interval.denominator);
  };
  for (const Mode& mode : modes) {
    if (mode.fourcc != format_.pixelformat || mode.width != format_.width) continue;
    for (const v4l2_fract& offered : mode.intervals)
      if (std::abs(seconds(offered) - seconds(asked)) <
          std::abs(seconds(interval_) - seconds(asked)))
        interval_ = offered;
  }
  parameters.parm.capture.timeperframe = interval_;
  return 0;
}

int ScriptedV4l2::reserve(v4l2_requestbuffers& request) {
  if (streaming_ || !mapped_.empty()) return EBUSY;
  request.count = std::min(request.count, driver_buffers);
  buffers_.assign(request.count, {std::vector<std::uint8_t>(format_.sizeimage), false});
  waiting_.clear();
  done_.clear();
  return 0;
}

int ScriptedV4l2::query(v4l2_buffer& buffer) const {
  if (buffer.index >= buffers_.size()) return EINVAL;
  buffer.length = format_.sizeimage;
  buffer.m.offset = buffer.index * 4096;
  return 0;
}

int ScriptedV4l2::queue(const v4l2_buffer& buffer) {
  if (buffer.index >= buffers_.size() || buffers_[buffer.index].queued) {
    ++violations;
    return EINVAL;
  }
  buffers_[buffer.index].queued = true;
  waiting_.push_back(static_cast<int>(buffer.index));
  return 0;
}

int ScriptedV4l2::dequeue(v4l2_buffer& buffer) {
  if (!streaming_) return EINVAL;
  if (done_.empty()) return EAGAIN;
  buffer = done_.front();
  done_.pop_front();
  if (buffer.index < buffers_.size()) buffers_[buffer.index].queued = false;
  return 0;
}

int ScriptedV4l2::stream_on() {
  streaming_ = true;
  ++starts;
  due_ = now_ + period;
  return 0;
}

int ScriptedV4l2::stream_off() {
  streaming_ = false;
  for (Buffer& buffer : buffers_) buffer.queued = false;
  waiting_.clear();
  done_.clear();
  return 0;
}

int ScriptedV4l2::query(v4l2_queryctrl& entry) const {
  const bool following = (entry.id & V4L2_CTRL_FLAG_NEXT_CTRL) != 0;
  const std::uint32_t id = entry.id & ~V4L2_CTRL_FLAG_NEXT_CTRL;
  const Control* found = nullptr;
  for (const Control& control : controls)
    if (following ? control.id > id && (found == nullptr || control.id < found->id)
                  : control.id == id)
      found = &control;
  if (found == nullptr) return EINVAL;
  entry = {};
  entry.id = found->id;
  entry.type = found->type;
  write_field(entry.name, found->name);
  entry.minimum = found->minimum;
  entry.maximum = found->maximum;
  entry.step = 1;
  return 0;
}

int ScriptedV4l2::get(v4l2_control& control) const {
  for (const Control& known : controls)
    if (known.id == control.id) {
      control.value = known.value;
      return 0;
    }
  return EINVAL;
}

int ScriptedV4l2::set(const v4l2_control& control) {
  for (Control& known : controls)
    if (known.id == control.id) {
      if (control.value < known.minimum || control.value > known.maximum) return ERANGE;
      known.value = control.value;
      return 0;
    }
  return EINVAL;
}

void* ScriptedV4l2::map(int descriptor, std::size_t length, std::int64_t offset) {
  const auto index = static_cast<std::size_t>(offset / 4096);
  if (!open_.contains(descriptor) || index >= buffers_.size()) {
    errno = EINVAL;
    return nullptr;
  }
  void* address = buffers_[index].memory.data();
  mapped_[address] = length;
  return address;
}

int ScriptedV4l2::unmap(void* address, std::size_t length) {
  const auto found = mapped_.find(address);
  if (found == mapped_.end() || found->second != length)
    ++violations;
  else
    mapped_.erase(found);
  return 0;
}

int ScriptedV4l2::poll(int descriptor, std::chrono::milliseconds timeout) {
  if (poll_fault_ != 0) {
    errno = std::exchange(poll_fault_, 0);
    return -1;
  }
  const std::chrono::nanoseconds end = now_ + timeout;
  while (true) {
    // A device that is gone and a stream that never started wake the wait as an error.
    if (!open_.contains(descriptor) || !open_[descriptor] || !streaming_) return 1;
    if (!done_.empty()) return 1;
    if (silent || due_ > end) {
      now_ = end;
      return 0;
    }
    now_ = std::max(now_, due_);
    expose();
  }
}

void ScriptedV4l2::pause(std::chrono::milliseconds duration) {
  const std::chrono::nanoseconds end = now_ + duration;
  while (streaming_ && !silent && due_ <= end) {
    now_ = std::max(now_, due_);
    expose();
  }
  now_ = end;
}

std::vector<std::filesystem::path> ScriptedV4l2::video_nodes() const {
  return plugged_ ? std::vector{node} : std::vector<std::filesystem::path>{};
}

ScriptedV4l2::Image ScriptedV4l2::next_image() const {
  Image image{count_, count_, now_, 0, {}, 0, false};
  const bool jpeg = is_jpeg(format_.pixelformat);
  const std::size_t size = jpeg                                       ? 200
                           : format_.pixelformat == V4L2_PIX_FMT_NV12 ? format_.sizeimage * 3 / 4
                                                                      : format_.sizeimage;
  image.bytes.assign(size, static_cast<std::uint8_t>(count_));
  if (jpeg) std::memcpy(image.bytes.data(), "\xff\xd8", 2);
  std::memcpy(image.bytes.data() + (jpeg ? 2 : 0), &count_, sizeof count_);
  image.bytes_used = static_cast<std::uint32_t>(size);
  return image;
}

void ScriptedV4l2::expose() {
  due_ += period;
  Image image = next_image();
  ++count_;
  if (const auto event = events.find(image.count); event != events.end()) {
    const auto happen = std::move(event->second);
    events.erase(event);
    happen();
    if (!streaming_) return;
  }
  if (spoil) spoil(image);
  if (image.dropped || waiting_.empty()) return;

  Buffer& buffer = buffers_[static_cast<std::size_t>(waiting_.front())];
  std::copy_n(image.bytes.begin(), std::min(image.bytes.size(), buffer.memory.size()),
              buffer.memory.begin());
  v4l2_buffer full{};
  full.index = static_cast<__u32>(waiting_.front());
  full.sequence = image.sequence;
  full.flags = image.flags;
  full.bytesused = image.bytes_used;
  const auto micro = std::chrono::duration_cast<std::chrono::microseconds>(image.stamp).count();
  full.timestamp.tv_sec = micro / 1000000;
  full.timestamp.tv_usec = micro % 1000000;
  waiting_.pop_front();
  done_.push_back(full);
}

}  // namespace sheen::capture::test
