// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <deque>
#include <thread>

namespace sheen::capture::test {

/// A bad network between a server and its clients: hands the bytes of each connection, one after
/// the other, through until so many have come from the server, then does what it is told.
class TcpRelay {
 public:
  enum class Fault { none, cut, stall, garbage };
  struct Connection {
    Fault fault = Fault::none;
    std::size_t after_bytes = 0;
  };

  /// After the last of `connections` clients are refused.
  TcpRelay(int server_port, std::deque<Connection> connections);
  ~TcpRelay();
  TcpRelay(const TcpRelay&) = delete;
  TcpRelay& operator=(const TcpRelay&) = delete;
  TcpRelay(TcpRelay&&) = delete;
  TcpRelay& operator=(TcpRelay&&) = delete;

  [[nodiscard]] int port() const { return port_; }

 private:
  void serve();
  void relay(int client, int server, const Connection& connection);

  int server_port_;
  std::deque<Connection> connections_;
  int listener_ = -1;
  int port_ = 0;
  int stop_reader_ = -1, stop_writer_ = -1;  ///< a pipe whose end ends everything
  std::jthread thread_;
};

}  // namespace sheen::capture::test
