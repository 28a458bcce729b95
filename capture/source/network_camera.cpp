// SPDX-License-Identifier: MIT
#include "capture/source/network_camera.h"

#include "capture/source/http_images.h"
#include "capture/source/network_address.h"
#include "capture/source/rtsp_pictures.h"

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
  description_.format = is_rtsp_address(options_.address) ? PixelFormat::video : PixelFormat::mjpeg;
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
  waiting_bytes_ -= current_.bytes.size();
  CameraBuffer buffer;
  buffer.format = description_.format;
  buffer.bytes = current_.bytes;
  buffer.width_px = description_.width_px;
  buffer.height_px = description_.height_px;
  buffer.time_s = current_.time_s;
  buffer.sequence = current_.sequence;
  buffer.is_key = current_.is_key;
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

/// Makes a connection; `gives_up` as those ask it.
std::unique_ptr<NetworkImages> NetworkCamera::connect(std::function<bool()> gives_up) {
  if (description_.format == PixelFormat::mjpeg) {
    return std::make_unique<HttpImages>(options_.address, std::move(gives_up));
  }
  auto pictures = std::make_unique<RtspPictures>(options_.address, std::move(gives_up));
  const std::lock_guard lock(mutex_);
  if (!description_.video) description_.video = pictures->header();
  if (description_.video->codec != pictures->header().codec) {
    throw core::Error(
        core::Error::Kind::run_failed, description_.device,
        fmt::format("sends {} now, {} before", pictures->header().codec, description_.video->codec),
        "keep its settings");
  }
  return pictures;
}

void NetworkCamera::receive_from_one_connection(const std::stop_token& stop) {
  const double asked_s = steady_now_s();
  double until_s = asked_s + options_.answer_s;
  const auto images = connect([&] { return stop.stop_requested() || steady_now_s() > until_s; });
  arrival_clock_.restart();
  stream_clock_.restart();
  const double connected_s = steady_now_s();
  bool is_stale = true;
  // What lay ready since the newest image that can be decoded by itself: those that follow may need
  // it. JPEG images need none.
  std::vector<Arrival> ready;
  while (true) {
    const double waiting_s = steady_now_s();
    Arrival arrival;
    const bool is_whole = images->next(arrival.image);
    arrival.time_s = steady_now_s();
    is_stale = is_stale && arrival.time_s - waiting_s < options_.stale_s &&
               arrival.time_s - connected_s < kMostStale_s;
    if (!is_whole) {
      if (!is_stale) note_damaged();
      continue;
    }
    until_s = arrival.time_s + options_.silence_s;
    if (arrival.image.stamp_s) stream_clock_.note(*arrival.image.stamp_s, arrival.time_s);
    if (arrival.image.is_key) ready.clear();
    ready.push_back(std::move(arrival));
    if (is_stale) continue;
    for (Arrival& image : ready) take(std::move(image));
    ready.clear();
  }
}

void NetworkCamera::take(Arrival arrival) {
  NetworkImage& image = arrival.image;
  const std::lock_guard lock(mutex_);
  if (last_image_s_ == 0) {
    description_.width_px = image.size.width_px;
    description_.height_px = image.size.height_px;
  }
  if (!(image.size == ImageSize{description_.width_px, description_.height_px})) {
    throw core::Error(
        core::Error::Kind::run_failed, description_.device,
        fmt::format("sends {}x{} images now, {}x{} before", image.size.width_px,
                    image.size.height_px, description_.width_px, description_.height_px),
        "keep its settings, and the phone as it was held");
  }
  counts_.reconnections += is_away_ ? 1 : 0;
  is_away_ = false;
  last_image_s_ = arrival.time_s;
  const double time_s = image.stamp_s ? stream_clock_.time_of(*image.stamp_s)
                                      : arrival_clock_.time_of(arrival.time_s);
  ++sequence_;
  // Nobody takes them any more. What needs a lost image is lost with it.
  const bool is_full = !waiting_.empty() && waiting_bytes_ + image.bytes.size() > kMostWaitingBytes;
  needs_key_ = (needs_key_ && !image.is_key) || is_full;
  if (needs_key_) {
    ++counts_.lost;
    return;
  }
  waiting_bytes_ += image.bytes.size();
  waiting_.push_back({std::move(image.bytes), time_s, sequence_, image.is_key});
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
