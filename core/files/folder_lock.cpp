// SPDX-License-Identifier: MIT
#include "core/files/folder_lock.h"

#include "core/diagnostics/error.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>

namespace sheen::core {
namespace {

constexpr std::size_t kLongestHolder = 300;

std::string this_process() {
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  return "process " + std::to_string(getpid()) + " on " + host.data();
}

/// What the file says, as far as it can be shown.
std::string holder_in(int file) {
  std::array<char, kLongestHolder> bytes{};
  const ssize_t count = pread(file, bytes.data(), bytes.size(), 0);
  std::string holder(bytes.data(), static_cast<std::size_t>(count > 0 ? count : 0));
  holder.resize(holder.find_first_of(std::string("\n\0", 2)) == std::string::npos
                    ? holder.size()
                    : holder.find_first_of(std::string("\n\0", 2)));
  for (char& c : holder) {
    if (c < ' ' || c > '~') c = '?';
  }
  return holder.empty() ? "another process" : holder;
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder) {
  const auto path = folder / ".lock";
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  // No O_TRUNC: the holder's name must stay readable.
  file_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (file_ < 0) {
    throw bad_input(folder, std::string("cannot be written (") + std::strerror(errno) + ")",
                    "check its permissions or choose another place");
  }
  if (flock(file_, LOCK_EX | LOCK_NB) != 0) {
    const bool is_held = errno == EWOULDBLOCK;
    const std::string fault = is_held
                                  ? "is in use by " + holder_in(file_)
                                  : std::string("cannot be locked (") + std::strerror(errno) + ")";
    close(file_);
    throw bad_input(folder, fault,
                    is_held ? "wait for it or end it" : "choose a place whose files can be locked");
  }
  // Only for people: on a full disk the lock holds all the same.
  const std::string holder = this_process() + "\n";
  if (ftruncate(file_, 0) != 0 ||
      pwrite(file_, holder.data(), holder.size(), 0) != static_cast<ssize_t>(holder.size())) {
    return;
  }
}

FolderLock::~FolderLock() {
  close(file_);
}

}  // namespace sheen::core
