// SPDX-License-Identifier: MIT
#include "capture/source/v4l2_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace sheen::capture {
namespace {

using namespace std::chrono_literals;

/// Between two attempts to open a camera that is away.
constexpr auto attempt_interval = 200ms;

/// Images exposed before the controls changed are on their way for a moment.
constexpr double after_lock_s = 0.2;

/// Where neither the list of modes nor the driver gives a rate.
constexpr double usual_fps = 30;

std::chrono::nanoseconds seconds(double duration_s) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
      std::chrono::duration<double>(duration_s));
}

/// Rounded up, so that a wait does not end early and become a busy loop.
std::chrono::milliseconds until(std::chrono::nanoseconds deadline, std::chrono::nanoseconds now) {
  return std::max(std::chrono::ceil<std::chrono::milliseconds>(deadline - now), 0ms);
}

std::string listed(const std::vector<CameraMode>& modes) {
  std::string text;
  for (const CameraMode& mode : modes)
    text += fmt::format("{}{} {}x{} at {:g}", text.empty() ? "" : ", ", format_name(mode.format),
                        mode.size.width_px, mode.size.height_px, mode.fps);
  return text;
}

CameraMode chosen_mode(const V4l2Device& device, const ModeWish& wish) {
  const auto modes = camera_modes(device);
  if (modes.empty())
    throw V4l2Error(core::Error::Kind::bad_input, device.node(),
                    "the camera has no format that can be read (MJPG, YUYV, NV12)",
                    "use another camera");
  const auto mode = choose_mode(modes, wish);
  if (!mode)
    throw V4l2Error(core::Error::Kind::bad_input, device.node(),
                    "the camera does not have this format or size",
                    "choose one of " + listed(modes));
  return *mode;
}

}  // namespace

V4l2Camera::Connection::Connection(V4l2Device opened, const CameraMode& mode)
    : device(std::move(opened)), active(set_mode(device, mode)), stream(device, active) {}

V4l2Camera::V4l2Camera(V4l2System& system, V4l2CameraOptions options)
    : system_(system), options_(std::move(options)) {
  V4l2Device device(system_, options_.device);
  mode_ = chosen_mode(device, options_.mode);
  hold_frame_rate(device);
  set_controls(device, options_.controls);
  bus_ = device.bus();
  description_.name = device.name();
  description_.device = options_.device.string();
  description_.format = mode_.format;
  description_.width_px = mode_.size.width_px;
  description_.height_px = mode_.size.height_px;
  connection_ = std::make_unique<Connection>(std::move(device), mode_);
  description_.fps = connection_->active.mode.fps > 0 ? connection_->active.mode.fps
                     : mode_.fps > 0                  ? mode_.fps
                                                      : usual_fps;
  start();
}

void V4l2Camera::start() {
  if (options_.lock_automatics) {
    discard(options_.settle_s);
    locked_ = lock_automatics(connection_->device);
    discard(after_lock_s);
  }
  last_heard_ = system_.now();
}

void V4l2Camera::discard(double duration_s) {
  const Time end = system_.now() + seconds(duration_s);
  while (system_.now() < end)
    static_cast<void>(connection_->stream.next(until(end, system_.now())));
}

std::optional<CameraBuffer> V4l2Camera::next(std::chrono::milliseconds timeout) {
  const Time deadline = system_.now() + timeout;
  do {
    check_patience();
    if (!connection_) reconnect(deadline);
    if (!connection_) continue;
    if (auto buffer = receive(deadline)) return buffer;
  } while (system_.now() < deadline);
  return std::nullopt;
}

std::optional<CameraBuffer> V4l2Camera::receive(Time deadline) {
  const Time silent_at = last_heard_ + seconds(options_.silence_s);
  std::optional<V4l2Image> image;
  try {
    const Time now = system_.now();
    image = connection_->stream.next(until(std::min(deadline, silent_at), now));
  } catch (const V4l2Error& error) {
    disconnect(error.fault());
    return std::nullopt;
  }
  if (image) return deliver(*image);
  if (system_.now() >= silent_at)
    disconnect(fmt::format("no image came for {:g} s", options_.silence_s));
  return std::nullopt;
}

std::optional<CameraBuffer> V4l2Camera::deliver(const V4l2Image& image) {
  last_heard_ = system_.now();
  const ImageOrder::Place place = order_.place(image.sequence);
  counts_.lost += place.lost;
  if (image.damaged) {
    ++counts_.damaged;
    return std::nullopt;
  }
  if (failing_since_) {
    ++counts_.reconnections;
    failing_since_.reset();
  }
  CameraBuffer buffer;
  buffer.format = mode_.format;
  buffer.bytes = image.bytes;
  buffer.width_px = mode_.size.width_px;
  buffer.height_px = mode_.size.height_px;
  buffer.bytes_per_line = connection_->active.bytes_per_line;
  buffer.time_s = order_.stamp_s(image.stamp, last_heard_);
  buffer.sequence = place.sequence;
  return buffer;
}

void V4l2Camera::disconnect(const std::string& fault) {
  connection_.reset();
  order_.restart();
  last_fault_ = fault;
  const Time now = system_.now();
  if (!failing_since_) failing_since_ = now;
  next_attempt_ = now;
}

void V4l2Camera::check_patience() const {
  if (!failing_since_ || system_.now() - *failing_since_ < seconds(options_.reconnect_s)) return;
  throw V4l2Error(core::Error::Kind::run_failed, options_.device,
                  fmt::format("the camera failed and was not back within {:g} s ({})",
                              options_.reconnect_s, last_fault_),
                  "check the cable and start again; what was recorded is kept");
}

V4l2Device V4l2Camera::find_again() {
  // A camera that is plugged in again may get another number, and another camera its number.
  std::vector<std::filesystem::path> nodes = system_.video_nodes();
  std::erase(nodes, options_.device);
  nodes.insert(nodes.begin(), options_.device);
  for (const auto& node : nodes) {
    const bool old_node = node == options_.device;
    try {
      V4l2Device device(system_, node);
      if (device.name() == description_.name && (old_node || device.bus() == bus_)) return device;
    } catch (const V4l2Error& error) {
      if (old_node) last_fault_ = error.fault();
    }
  }
  throw V4l2Error(core::Error::Kind::run_failed, options_.device, last_fault_, "plug it in again");
}

void V4l2Camera::reconnect(Time deadline) {
  const Time now = system_.now();
  if (now < next_attempt_) {
    system_.pause(until(std::min(deadline, next_attempt_), now));
    return;
  }
  next_attempt_ = now + attempt_interval;
  try {
    V4l2Device device = find_again();
    hold_frame_rate(device);
    restore_controls(device, options_.controls);
    restore_controls(device, locked_);
    connection_ = std::make_unique<Connection>(std::move(device), mode_);
    last_heard_ = system_.now();
  } catch (const V4l2Error& error) {
    last_fault_ = error.fault();
  }
}

}  // namespace sheen::capture
