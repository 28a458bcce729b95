// SPDX-License-Identifier: MIT
#include "app/start/camera_looks.h"

#include "capture/source/jpeg_decoder.h"
#include "capture/source/jpeg_encoder.h"
#include "capture/source/network_address.h"
#include "capture/source/network_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

namespace sheen::app {
namespace {

constexpr double kSettle_s = 0.4;  // so that the picture is not the first, dark one
constexpr double kAnswer_s = 4;
constexpr int kTries = 30;
constexpr auto kTry = std::chrono::milliseconds(100);

std::unique_ptr<capture::Camera> open_for_a_moment(const std::string& address) {
  if (capture::is_network_address(address)) {
    return std::make_unique<capture::NetworkCamera>(
        capture::NetworkCameraOptions{.address = address, .answer_s = kAnswer_s});
  }
  return std::make_unique<capture::V4l2Camera>(
      capture::kernel_v4l2_system(),
      capture::V4l2CameraOptions{
          .device = address, .lock_automatics = false, .settle_s = kSettle_s});
}

/// Nothing when the bytes are no image.
cv::Mat decoded(const capture::CameraBuffer& buffer) {
  capture::JpegEncoder encoder;
  const auto packed = buffer.format == capture::PixelFormat::mjpeg
                          ? std::vector<std::uint8_t>(buffer.bytes.begin(), buffer.bytes.end())
                          : encoder.encode(buffer);
  const auto size = capture::jpeg_size(packed);
  cv::Mat picture;
  if (!size || !capture::decode_jpeg(packed, *size, picture)) return {};
  return picture;
}

cv::Mat picture_of(capture::Camera& camera) {
  for (int i = 0; i < kTries; ++i) {
    const auto buffer = camera.next(kTry);
    if (!buffer) continue;
    if (buffer->format == capture::PixelFormat::video) return {};
    if (cv::Mat picture = decoded(*buffer); !picture.empty()) return picture;
  }
  throw core::Error(core::Error::Kind::run_failed, camera.description().device, "delivers no image",
                    "close other programs that use it");
}

}  // namespace

CameraAccess cameras_of_this_machine() {
  return {.list = [] { return capture::list_cameras(capture::kernel_v4l2_system()); },
          .open = open_for_a_moment};
}

CameraLook look_through(const CameraAccess& cameras, const std::string& address,
                        const std::string& name) {
  CameraLook look{.address = address, .name = name, .is_due = false};
  try {
    const auto camera = cameras.open(address);
    const capture::CameraDescription found = camera->description();
    if (look.name.empty()) look.name = found.name;
    look.mode = fmt::format("{}x{}, {:g} a second", found.width_px, found.height_px, found.fps);
    look.picture = picture_of(*camera);
  } catch (const std::exception& error) {
    look.fault = error.what();
  }
  return look;
}

CameraLooks::CameraLooks(CameraAccess cameras, std::function<void()> on_news)
    : cameras_(std::move(cameras)),
      on_news_(std::move(on_news)),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

std::vector<CameraLook> CameraLooks::looks() const {
  const std::lock_guard lock(mutex_);
  return {looks_.begin(), looks_.end()};
}

bool CameraLooks::is_listing() const {
  const std::lock_guard lock(mutex_);
  return is_listing_;
}

void CameraLooks::add(const std::string& address) {
  {
    const std::lock_guard lock(mutex_);
    CameraLook* const known = find(address);
    if (known != nullptr) {
      known->is_due = true;
      known->fault.clear();
    } else {
      looks_.push_back({.address = address});
    }
  }
  has_work_.notify_all();
}

CameraLook* CameraLooks::find(const std::string& address) {
  const auto look = std::ranges::find(looks_, address, &CameraLook::address);
  return look == looks_.end() ? nullptr : &*look;
}

void CameraLooks::list() {
  std::vector<capture::CameraListing> found;
  try {
    found = cameras_.list();
  } catch (const std::exception&) {  // no cameras, then; an address can be given all the same
  }
  const std::lock_guard lock(mutex_);
  is_listing_ = false;
  for (const capture::CameraListing& camera : found) {
    looks_.push_back({.address = camera.device.string(),
                      .name = camera.name,
                      .fault = camera.fault,
                      .is_due = camera.fault.empty()});
  }
}

void CameraLooks::run(const std::stop_token& stop) {
  list();
  while (true) {
    if (on_news_) on_news_();
    // The next camera nobody has looked through.
    std::string address;
    std::string name;
    {
      std::unique_lock lock(mutex_);
      const auto next = [this] { return std::ranges::find(looks_, true, &CameraLook::is_due); };
      if (!has_work_.wait(lock, stop, [&] { return next() != looks_.end(); })) return;
      if (stop.stop_requested()) return;
      address = next()->address;
      name = next()->name;
    }
    CameraLook look = look_through(cameras_, address, name);
    const std::lock_guard lock(mutex_);
    if (CameraLook* const place = find(address)) *place = std::move(look);
  }
}

}  // namespace sheen::app
