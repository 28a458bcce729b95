// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace sheen::capture::test {

/// One connection of a client that has asked for something.
class HttpConnection {
 public:
  explicit HttpConnection(int socket, std::string request)
      : socket_(socket), request_(std::move(request)) {}

  /// What the client asked, its headers.
  [[nodiscard]] const std::string& request() const { return request_; }

  /// Sends all of it; false when the client is gone.
  bool send(const std::string& bytes) const;

  /// The heading of an answer that never ends, whose parts are images.
  bool begin_images() const;
  /// One part; `with_length` as most servers do.
  bool send_image(const std::vector<std::uint8_t>& jpeg, bool with_length = true) const;

  /// Sends nothing until the client hangs up.
  void wait_for_end() const;

 private:
  int socket_;
  std::string request_;
};

/// A server on the loopback that does to each connection, one after the other, what a script says;
/// after the last script connections are refused. No address of it is ever in the network.
class ScriptedHttp {
 public:
  using Script = std::function<void(HttpConnection&)>;

  explicit ScriptedHttp(std::deque<Script> scripts);
  ~ScriptedHttp();
  ScriptedHttp(const ScriptedHttp&) = delete;
  ScriptedHttp& operator=(const ScriptedHttp&) = delete;
  ScriptedHttp(ScriptedHttp&&) = delete;
  ScriptedHttp& operator=(ScriptedHttp&&) = delete;

  /// "http://127.0.0.1:PORT/video"; `user` stands before the host.
  [[nodiscard]] std::string address(const std::string& user = "") const;

 private:
  void serve();

  std::deque<Script> scripts_;
  int listener_ = -1;
  int port_ = 0;
  std::mutex mutex_;
  int connection_ = -1;
  bool is_over_ = false;
  std::jthread thread_;
};

/// FFmpeg's own server, another program: serves `seconds` of a test pattern of 64 x 48 at 30 images
/// a second to its first client. Killed with this object.
class FfmpegServer {
 public:
  explicit FfmpegServer(int seconds);
  ~FfmpegServer();
  FfmpegServer(const FfmpegServer&) = delete;
  FfmpegServer& operator=(const FfmpegServer&) = delete;
  FfmpegServer(FfmpegServer&&) = delete;
  FfmpegServer& operator=(FfmpegServer&&) = delete;

  /// False where the program is not installed.
  [[nodiscard]] bool is_there() const { return process_ > 0; }
  [[nodiscard]] const std::string& address() const { return address_; }

 private:
  int process_ = -1;
  std::string address_;
};

}  // namespace sheen::capture::test
