// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/network_images.h"

#include <functional>
#include <memory>
#include <string>

namespace sheen::capture {

/// JPEG images that a server sends one after the other (multipart/x-mixed-replace), as phones and
/// ustreamer do, over HTTP by FFmpeg's libraries: redirections, passwords in the address and TLS
/// included.
class HttpImages : public NetworkImages {
 public:
  /// Connects. `gives_up` is asked again and again while this or `next` waits. Throws NetworkFault.
  HttpImages(const std::string& address, std::function<bool()> gives_up);
  ~HttpImages() override;
  HttpImages(const HttpImages&) = delete;
  HttpImages& operator=(const HttpImages&) = delete;
  HttpImages(HttpImages&&) = delete;
  HttpImages& operator=(HttpImages&&) = delete;

  /// False for an image that was cut short or is no JPEG.
  bool next(NetworkImage& image) override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sheen::capture
