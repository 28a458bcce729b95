// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/frame_range.h"

#include <cstdint>
#include <optional>
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

/// The fault behind an error of FFmpeg's libraries while connecting.
NetworkFault connection_fault(int status);

/// One image as it came over a network.
struct NetworkImage {
  std::vector<std::uint8_t> bytes;
  ImageSize size;
  std::optional<double> stamp_s;  ///< of the sender's clock, where the stream states one
  bool is_key = true;             ///< can be decoded without those before it
};

/// The images of one connection.
class NetworkImages {
 public:
  virtual ~NetworkImages() = default;

  /// Waits for the next image. False for one that came damaged. Throws NetworkFault when the
  /// connection ends or its owner gives it up.
  virtual bool next(NetworkImage& image) = 0;
};

}  // namespace sheen::capture
