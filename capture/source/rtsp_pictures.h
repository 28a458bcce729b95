// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/camera.h"
#include "capture/source/network_images.h"

#include <functional>
#include <memory>
#include <string>

namespace sheen::capture {

/// Pictures of an H.264 or H.265 video that a server sends by RTSP, still compressed, by FFmpeg's
/// libraries: over TCP, so that none is lost on the way; passwords in the address and TLS included.
/// A picture is whole when the next one begins, so it comes as late as that; the last one comes
/// when the connection ends or is given up.
class RtspPictures : public NetworkImages {
 public:
  /// Connects and waits for the first picture that can be decoded by itself, which tells the size.
  /// `gives_up` is asked again and again while this or `next` waits. Throws NetworkFault.
  RtspPictures(const std::string& address, std::function<bool()> gives_up);
  ~RtspPictures() override;
  RtspPictures(const RtspPictures&) = delete;
  RtspPictures& operator=(const RtspPictures&) = delete;
  RtspPictures(RtspPictures&&) = delete;
  RtspPictures& operator=(RtspPictures&&) = delete;

  [[nodiscard]] const VideoHeader& header() const;

  /// The first is the one waited for; it holds the parameter sets, which after a connection was
  /// made again may be others.
  bool next(NetworkImage& image) override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sheen::capture
