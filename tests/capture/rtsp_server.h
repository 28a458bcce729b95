// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

namespace sheen::capture::test {

/// GStreamer's RTSP server, another program (rtsp_server.py): serves a file's H.264 video as it is,
/// at its own pace, to every client from its beginning. Ends with this object.
class RtspServer {
 public:
  /// Lets only the user `me` with the password `secret` in where `has_password`.
  explicit RtspServer(const std::filesystem::path& video, bool has_password = false);
  ~RtspServer();
  RtspServer(const RtspServer&) = delete;
  RtspServer& operator=(const RtspServer&) = delete;
  RtspServer(RtspServer&&) = delete;
  RtspServer& operator=(RtspServer&&) = delete;

  /// 0 where it is not installed.
  [[nodiscard]] int port() const { return port_; }

 private:
  int process_ = -1;
  int input_ = -1;  ///< the server ends when this is closed
  int port_ = 0;
};

/// "rtsp://USER127.0.0.1:PORT/video?token=secret"; `user` may be empty or end with @.
std::string rtsp_address(int port, const std::string& user = "");

}  // namespace sheen::capture::test
