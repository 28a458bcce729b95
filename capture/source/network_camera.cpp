// SPDX-License-Identifier: MIT
#include "capture/source/network_camera.h"

#include "capture/source/http_images.h"
#include "capture/source/jpeg_decoder.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace sheen::capture {
namespace {

constexpr double kNominalFps = 30;  // servers state none; the recording's own stamps win
constexpr std::size_t kMostWaitingBytes = std::size_t{64} << 20;
constexpr double kMostStale_s = 0.5;  // but a server faster than we ask never runs dry
constexpr auto kRetry = std::chrono::milliseconds(300);

double steady_now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

core::Error error_of(const std::string& address, const NetworkFault& fault) {
  return {fault.is_permanent() ? core::Error::Kind::bad_input : core::Error::Kind::run_failed,
          shown_address(address), fault.what(), fault.remedy()};
}

}  // namespace

NetworkCamera::NetworkCamera(const NetworkCameraOptions& options) : options_(options) {
  description_.device = shown_address(options_.address);
  description_.name = description_.device;
  description_.format = PixelFormat::mjpeg;
  description_.fps = kNominalFps;
  receiver_ = std::jthread([this](const std::stop_token& stop) { receive(stop); });
  std::unique_lock lock(mutex_);
  has_news_.wait(lock, [this] { return fault_ || !waiting_.empty(); });
  if (waiting_.empty()) throw core::Error(*fault_);
}

NetworkCamera::~NetworkCamera() = default;

std::optional<CameraBuffer> NetworkCamera::next(std::chrono::milliseconds timeout) {
  std::unique_lock lock(mutex_);
  has_news_.wait_for(lock, timeout, [this] { return fault_ || !waiting_.empty(); });
  if (waiting_.empty()) {
    if (fault_) throw core::Error(*fault_);
    return std::nullopt;
  }
  current_ = std::move(waiting_.front());
  waiting_.pop_front();
  waiting_bytes_ -= current_.jpeg.size();
  CameraBuffer buffer;
  buffer.format = PixelFormat::mjpeg;
  buffer.bytes = current_.jpeg;
  buffer.width_px = description_.width_px;
  buffer.height_px = description_.height_px;
  buffer.time_s = current_.time_s;
  buffer.sequence = current_.sequence;
  return buffer;
}

CameraCounts NetworkCamera::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

/// Connects, takes images, connects again, until there is no more hope.
void NetworkCamera::receive(const std::stop_token& stop) {
  double away_since_s = steady_now_s();
  while (!stop.stop_requested()) {
    const double last_s = last_image_s_;
    try {
      receive_from_one_connection(stop);
    } catch (const NetworkFault& fault) {
      const double now_s = steady_now_s();
      if (last_image_s_ > last_s) away_since_s = now_s;
      // Who has never sent an image is not waited for.
      const bool is_hopeless = fault.is_permanent() || last_image_s_ == 0 ||
                               now_s - away_since_s >= options_.reconnect_s;
      if (is_hopeless) return fail(error_of(options_.address, fault));
      is_away_ = true;
    } catch (const core::Error& error) {
      return fail(error);
    } catch (const std::exception& error) {
      return fail({core::Error::Kind::run_failed, shown_address(options_.address),
                   std::string("recording has stopped: ") + error.what(),
                   "what was recorded is kept"});
    }
    std::unique_lock lock(mutex_);
    pause_.wait_for(lock, stop, kRetry, [] { return false; });
  }
}

void NetworkCamera::receive_from_one_connection(const std::stop_token& stop) {
  const double asked_s = steady_now_s();
  double until_s = asked_s + options_.answer_s;
  HttpImages images(options_.address,
                    [&] { return stop.stop_requested() || steady_now_s() > until_s; });
  clock_.restart();
  const double connected_s = steady_now_s();
  bool is_stale = true;
  while (true) {
    const double waiting_s = steady_now_s();
    std::vector<std::uint8_t> jpeg;
    const bool is_whole = images.next(jpeg);
    const double arrival_s = steady_now_s();
    is_stale = is_stale && arrival_s - waiting_s < options_.stale_s &&
               arrival_s - connected_s < kMostStale_s;
    if (is_stale) continue;
    if (is_whole) {
      until_s = arrival_s + options_.silence_s;
      take(std::move(jpeg), arrival_s);
    } else {
      note_damaged();
    }
  }
}

void NetworkCamera::take(std::vector<std::uint8_t> jpeg, double arrival_s) {
  const ImageSize size = *jpeg_size(jpeg);
  const std::lock_guard lock(mutex_);
  if (last_image_s_ == 0) {
    description_.width_px = size.width_px;
    description_.height_px = size.height_px;
  }
  if (!(size == ImageSize{description_.width_px, description_.height_px})) {
    throw core::Error(core::Error::Kind::run_failed, description_.device,
                      fmt::format("sends {}x{} images now, {}x{} before", size.width_px,
                                  size.height_px, description_.width_px, description_.height_px),
                      "keep its settings, and the phone as it was held");
  }
  counts_.reconnections += is_away_ ? 1 : 0;
  is_away_ = false;
  last_image_s_ = arrival_s;
  const double time_s = clock_.time_of(arrival_s);
  ++sequence_;
  if (!waiting_.empty() &&
      waiting_bytes_ + jpeg.size() > kMostWaitingBytes) {  // nobody takes them any more
    ++counts_.lost;
    return;
  }
  waiting_bytes_ += jpeg.size();
  waiting_.push_back({std::move(jpeg), time_s, sequence_});
  has_news_.notify_all();
}

void NetworkCamera::note_damaged() {
  const std::lock_guard lock(mutex_);
  ++counts_.damaged;
}

void NetworkCamera::fail(const core::Error& fault) {
  {
    const std::lock_guard lock(mutex_);
    fault_ = fault;
  }
  has_news_.notify_all();
}

}  // namespace sheen::capture
