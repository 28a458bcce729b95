// SPDX-License-Identifier: MIT
#include "tests/capture/tcp_relay.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <random>
#include <stdexcept>

namespace sheen::capture::test {
namespace {

sockaddr_in on_loopback(int port) {
  sockaddr_in name{};
  name.sin_family = AF_INET;
  name.sin_port = htons(static_cast<std::uint16_t>(port));
  name.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return name;
}

int connect_to(int port) {
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const sockaddr_in name = on_loopback(port);
  if (::connect(socket, reinterpret_cast<const sockaddr*>(&name), sizeof(name)) == 0) return socket;
  ::close(socket);
  return -1;
}

bool send_all(int socket, const char* bytes, std::size_t count) {
  while (count > 0) {
    const ssize_t sent = ::send(socket, bytes, count, MSG_NOSIGNAL);
    if (sent <= 0) return false;
    bytes += sent;
    count -= static_cast<std::size_t>(sent);
  }
  return true;
}

void send_garbage(int socket) {
  std::mt19937 random(3);
  std::array<char, 4096> noise{};
  for (int i = 0; i < 50; ++i) {
    for (char& byte : noise) byte = static_cast<char>(random());
    if (!send_all(socket, noise.data(), noise.size())) return;
  }
}

}  // namespace

TcpRelay::TcpRelay(int server_port, std::deque<Connection> connections)
    : server_port_(server_port), connections_(std::move(connections)) {
  listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in name = on_loopback(0);
  socklen_t size = sizeof(name);
  auto* const address = reinterpret_cast<sockaddr*>(&name);
  std::array<int, 2> ends{};
  if (listener_ < 0 || ::bind(listener_, address, size) != 0 || ::listen(listener_, 4) != 0 ||
      ::getsockname(listener_, address, &size) != 0 || ::pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw std::runtime_error("no server on the loopback");
  }
  stop_reader_ = ends[0];
  stop_writer_ = ends[1];
  port_ = ntohs(name.sin_port);
  thread_ = std::jthread([this] { serve(); });
}

TcpRelay::~TcpRelay() {
  ::close(stop_writer_);
  thread_.join();
  ::close(stop_reader_);
  if (listener_ >= 0) ::close(listener_);
}

void TcpRelay::serve() {
  while (!connections_.empty()) {
    std::array<pollfd, 2> both{{{listener_, POLLIN, 0}, {stop_reader_, POLLIN, 0}}};
    if (::poll(both.data(), both.size(), -1) < 0 || both[1].revents != 0) return;
    const int client = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    const int server = connect_to(server_port_);
    if (server >= 0) relay(client, server, connections_.front());
    connections_.pop_front();
    ::close(server);
    ::close(client);
  }
  ::close(listener_);
  listener_ = -1;
}

void TcpRelay::relay(int client, int server, const Connection& connection) {
  std::array<char, 4096> part{};
  std::size_t passed = 0;
  bool is_stalled = false;
  while (true) {
    std::array<pollfd, 3> all{
        {{client, POLLIN, 0}, {is_stalled ? -1 : server, POLLIN, 0}, {stop_reader_, POLLIN, 0}}};
    if (::poll(all.data(), all.size(), -1) < 0 || all[2].revents != 0) return;
    if (all[0].revents != 0) {
      const ssize_t count = ::recv(client, part.data(), part.size(), 0);
      if (count <= 0) return;
      if (!is_stalled && !send_all(server, part.data(), static_cast<std::size_t>(count))) return;
    }
    if (all[1].revents == 0) continue;
    const bool is_good = connection.fault == Fault::none;
    const std::size_t most =
        is_good ? part.size() : std::min(part.size(), connection.after_bytes - passed);
    const ssize_t count = ::recv(server, part.data(), most, 0);
    if (count <= 0 || !send_all(client, part.data(), static_cast<std::size_t>(count))) return;
    passed += static_cast<std::size_t>(count);
    if (is_good || passed < connection.after_bytes) continue;
    if (connection.fault == Fault::cut) return;
    if (connection.fault == Fault::garbage) send_garbage(client);
    is_stalled = true;
  }
}

}  // namespace sheen::capture::test
