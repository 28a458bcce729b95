// SPDX-License-Identifier: MIT
#include "tests/capture/scripted_http.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <stdexcept>

namespace sheen::capture::test {
namespace {

std::string read_request(int socket) {
  std::string request;
  std::array<char, 1024> part{};
  while (request.find("\r\n\r\n") == std::string::npos) {
    const ssize_t count = ::recv(socket, part.data(), part.size(), 0);
    if (count <= 0) break;
    request.append(part.data(), static_cast<std::size_t>(count));
  }
  return request;
}

}  // namespace

bool HttpConnection::send(const std::string& bytes) const {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count = ::send(socket_, bytes.data() + done, bytes.size() - done, MSG_NOSIGNAL);
    if (count <= 0) return false;
    done += static_cast<std::size_t>(count);
  }
  return true;
}

bool HttpConnection::begin_images() const {
  return send(
      "HTTP/1.0 200 OK\r\nConnection: close\r\nCache-Control: no-store\r\n"
      "Content-Type: multipart/x-mixed-replace;boundary=imageboundary\r\n\r\n--imageboundary\r\n");
}

bool HttpConnection::send_image(const std::vector<std::uint8_t>& jpeg, bool with_length) const {
  std::string part = "Content-Type: image/jpeg\r\n";
  if (with_length) part += "Content-Length: " + std::to_string(jpeg.size()) + "\r\n";
  part += "\r\n";
  part.append(jpeg.begin(), jpeg.end());
  return send(part + "\r\n--imageboundary\r\n");
}

void HttpConnection::wait_for_end() const {
  std::array<char, 64> part{};
  while (::recv(socket_, part.data(), part.size(), 0) > 0) {
  }
}

ScriptedHttp::ScriptedHttp(std::deque<Script> scripts) : scripts_(std::move(scripts)) {
  listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in any{};
  any.sin_family = AF_INET;
  any.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof(any);
  auto* const name = reinterpret_cast<sockaddr*>(&any);
  if (listener_ < 0 || ::bind(listener_, name, size) != 0 || ::listen(listener_, 4) != 0 ||
      ::getsockname(listener_, name, &size) != 0) {
    throw std::runtime_error("no server on the loopback");
  }
  port_ = ntohs(any.sin_port);
  thread_ = std::jthread([this] { serve(); });
}

ScriptedHttp::~ScriptedHttp() {
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
    if (connection_ >= 0) ::shutdown(connection_, SHUT_RDWR);
    ::shutdown(listener_, SHUT_RDWR);  // wakes accept
  }
  thread_.join();
  ::close(listener_);
}

std::string ScriptedHttp::address(const std::string& user) const {
  return "http://" + user + (user.empty() ? "" : "@") + "127.0.0.1:" + std::to_string(port_) +
         "/video?token=secret";
}

void ScriptedHttp::serve() {
  while (!scripts_.empty()) {
    const int socket = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    {
      const std::lock_guard lock(mutex_);
      if (socket < 0 || is_over_) break;
      connection_ = socket;
    }
    HttpConnection connection(socket, read_request(socket));
    scripts_.front()(connection);
    scripts_.pop_front();
    const std::lock_guard lock(mutex_);
    connection_ = -1;
    ::shutdown(socket, SHUT_WR);
    ::close(socket);
  }
  const std::lock_guard lock(mutex_);
  if (!is_over_) ::shutdown(listener_, SHUT_RDWR);
}

FfmpegServer::FfmpegServer(int seconds) {
  {
    const ScriptedHttp free({});  // a port that nobody uses
    address_ = free.address();
    address_.resize(address_.find('?'));
  }
  const std::string length = std::to_string(seconds);
  std::vector<std::string> words = {"ffmpeg",
                                    "-v",
                                    "quiet",
                                    "-re",
                                    "-f",
                                    "lavfi",
                                    "-t",
                                    length,
                                    "-i",
                                    "testsrc=size=64x48:rate=30",
                                    "-f",
                                    "mpjpeg",
                                    "-content_type",
                                    "multipart/x-mixed-replace;boundary=ffmpeg",
                                    "-listen",
                                    "1",
                                    address_};
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  if (posix_spawnp(&process_, "ffmpeg", nullptr, nullptr, arguments.data(), environ) != 0) {
    process_ = -1;
  }
}

FfmpegServer::~FfmpegServer() {
  if (process_ <= 0) return;
  ::kill(process_, SIGKILL);
  ::waitpid(process_, nullptr, 0);
}

}  // namespace sheen::capture::test
