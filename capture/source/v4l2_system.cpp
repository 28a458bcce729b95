// SPDX-License-Identifier: MIT
#include "capture/source/v4l2_system.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <optional>
#include <string>
#include <thread>
#include <utility>

namespace sheen::capture {
namespace {

namespace fs = std::filesystem;

/// A signal such as a resized terminal must not look like a broken camera.
template <class Call>
auto repeat_when_interrupted(const Call& call) {
  auto result = call();
  while (result == -1 && errno == EINTR) result = call();
  return result;
}

/// 7 of "video7".
std::optional<int> node_number(const std::string& name) {
  static const std::string prefix = "video";
  if (!name.starts_with(prefix)) return std::nullopt;
  int number = 0;
  const char* end = name.data() + name.size();
  const auto [stop, fault] = std::from_chars(name.data() + prefix.size(), end, number);
  return fault == std::errc() && stop == end ? std::optional(number) : std::nullopt;
}

class KernelSystem : public V4l2System {
 public:
  int open(const fs::path& node) override {
    return repeat_when_interrupted(
        [&] { return ::open(node.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC); });
  }

  int close(int descriptor) override { return ::close(descriptor); }

  int ioctl(int descriptor, unsigned long request, void* argument) override {
    return repeat_when_interrupted([&] { return ::ioctl(descriptor, request, argument); });
  }

  void* map(int descriptor, std::size_t length, std::int64_t offset) override {
    void* address = ::mmap(nullptr, length, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, offset);
    return address == MAP_FAILED ? nullptr : address;
  }

  int unmap(void* address, std::size_t length) override { return ::munmap(address, length); }

  int poll(int descriptor, std::chrono::milliseconds timeout) override {
    pollfd wanted{descriptor, POLLIN, 0};
    const int ready = ::poll(&wanted, 1, static_cast<int>(timeout.count()));
    // A signal ends the wait early: the caller decides whether to go on.
    return ready == -1 && errno == EINTR ? 0 : ready;
  }

  std::vector<fs::path> video_nodes() const override {
    std::vector<std::pair<int, fs::path>> found;
    std::error_code unreadable;
    for (const auto& entry : fs::directory_iterator("/dev", unreadable)) {
      const auto number = node_number(entry.path().filename().string());
      if (number) found.emplace_back(*number, entry.path());
    }
    std::sort(found.begin(), found.end());
    std::vector<fs::path> nodes;
    for (auto& [number, path] : found) nodes.push_back(std::move(path));
    return nodes;
  }

  std::chrono::nanoseconds now() const override {
    return std::chrono::steady_clock::now().time_since_epoch();
  }

  void pause(std::chrono::milliseconds duration) override { std::this_thread::sleep_for(duration); }
};

}  // namespace

V4l2System& kernel_v4l2_system() {
  static KernelSystem system;
  return system;
}

}  // namespace sheen::capture
