// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace sheen::capture {

/// What is wrong with a connection and what to do, without the address.
class NetworkFault : public std::runtime_error {
 public:
  NetworkFault(const std::string& fault, std::string remedy, bool is_permanent)
      : std::runtime_error(fault), remedy_(std::move(remedy)), is_permanent_(is_permanent) {}

  [[nodiscard]] const std::string& remedy() const { return remedy_; }
  /// Whether asking again is of no use: a wrong address, password or kind of stream.
  [[nodiscard]] bool is_permanent() const { return is_permanent_; }

 private:
  std::string remedy_;
  bool is_permanent_;
};

/// Whether an address names a camera in the network: http://, https:// or rtsp://.
bool is_network_address(const std::string& address);

/// The address as it may stand in messages and files: without user, password and query. Names of
/// files and devices stay as they are.
std::string shown_address(const std::string& address);

/// JPEG images that a server sends one after the other (multipart/x-mixed-replace), as phones and
/// ustreamer do, over HTTP by FFmpeg's libraries: redirections, passwords in the address and TLS
/// included.
class HttpImages {
 public:
  /// Connects. `gives_up` is asked again and again while this or `next` waits. Throws NetworkFault.
  HttpImages(const std::string& address, std::function<bool()> gives_up);
  ~HttpImages();
  HttpImages(const HttpImages&) = delete;
  HttpImages& operator=(const HttpImages&) = delete;
  HttpImages(HttpImages&&) = delete;
  HttpImages& operator=(HttpImages&&) = delete;

  /// Waits for the next image and takes its bytes. False for one that was cut short or is no JPEG.
  /// Throws NetworkFault when the connection ends or `gives_up` says so.
  bool next(std::vector<std::uint8_t>& jpeg);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sheen::capture
