// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/arrival_clock.h"
#include "capture/source/camera.h"
#include "capture/source/network_images.h"
#include "capture/source/stream_clock.h"
#include "core/diagnostics/error.h"

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace sheen::capture {

/// How a camera in the network is to be used.
struct NetworkCameraOptions {
  std::string address;  ///< http(s):// or rtsp(s)://; may hold user and password, which stay secret
  double answer_s = 10;     ///< > 0, how long a server may take to answer and send an image
  double silence_s = 5;     ///< > 0, without an image a connection counts as broken
  double reconnect_s = 30;  ///< >= 0, how long a camera that went away may stay away
  /// After connecting, an image that comes within so short a wait lay ready before and is dropped.
  double stale_s = 0.001;
};

/// A phone or another camera that serves JPEG images over HTTP, or H.264 or H.265 video by RTSP. A
/// thread of its own takes every image off the network as it comes, so that a slow disk stops no
/// connection; what arrived is delivered before a fault is. Times are those of the stream, brought
/// to the steady clock (StreamClock), or where it states none those of the arrival, steadied
/// (ArrivalClock). Images that a server had ready before it was asked are stale and dropped, as far
/// as later ones can be decoded without them; after a cut it is asked again.
class NetworkCamera : public Camera {
 public:
  /// Connects and waits for the first image, which tells the size. Throws core::Error: bad_input
  /// for an address that leads nowhere or to something else, run_failed without an answer in time.
  explicit NetworkCamera(const NetworkCameraOptions& options);
  ~NetworkCamera() override;
  NetworkCamera(const NetworkCamera&) = delete;
  NetworkCamera& operator=(const NetworkCamera&) = delete;
  NetworkCamera(NetworkCamera&&) = delete;
  NetworkCamera& operator=(NetworkCamera&&) = delete;

  std::optional<CameraBuffer> next(std::chrono::milliseconds timeout) override;
  [[nodiscard]] CameraDescription description() const override { return description_; }
  [[nodiscard]] CameraCounts counts() const override;

 private:
  struct Image {
    std::vector<std::uint8_t> bytes;
    double time_s = 0;
    std::uint32_t sequence = 0;
    bool is_key = true;
  };
  struct Arrival {
    NetworkImage image;
    double time_s = 0;
  };

  void receive(const std::stop_token& stop);
  std::unique_ptr<NetworkImages> connect(std::function<bool()> gives_up);
  void receive_from_one_connection(const std::stop_token& stop);
  void take(Arrival arrival);
  void note_damaged();
  void fail(const core::Error& fault);

  NetworkCameraOptions options_;
  CameraDescription description_;
  ArrivalClock arrival_clock_;  ///< these five: of the receiving thread
  StreamClock stream_clock_;
  bool needs_key_ = false;   ///< an image was lost that the next ones need
  double last_image_s_ = 0;  ///< its arrival; 0: none so far
  bool is_away_ = false;     ///< the connection broke and no image came since
  std::condition_variable_any pause_;

  mutable std::mutex mutex_;
  std::condition_variable has_news_;
  /// Filled by the receiving thread, emptied by `next`. When this camera is destroyed what waits is
  /// lost with it; when the connection ends what waits is delivered first, then `fault_` is thrown.
  std::deque<Image> waiting_;
  std::size_t waiting_bytes_ = 0;
  std::uint32_t sequence_ = 0;
  CameraCounts counts_;
  std::optional<core::Error> fault_;  ///< the last word of the receiving thread
  Image current_;                     ///< whose bytes `next` has lent
  std::jthread receiver_;             ///< last: it uses all of the above
};

}  // namespace sheen::capture
