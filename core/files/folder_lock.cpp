// SPDX-License-Identifier: MIT
#include "core/files/folder_lock.h"

#include "core/diagnostics/error.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

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

int open_file(const std::filesystem::path& path) {
  // No O_TRUNC: the holder's name must stay readable.
  const int file = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (file < 0) {
    throw bad_input(path.parent_path(),
                    std::string("cannot be written (") + std::strerror(errno) + ")",
                    "check its permissions or choose another place");
  }
  return file;
}

void hold(int file, const std::filesystem::path& locked) {
  if (flock(file, LOCK_EX | LOCK_NB) == 0) return;
  const bool is_held = errno == EWOULDBLOCK;
  const std::string fault = is_held
                                ? "is in use by " + holder_in(file)
                                : std::string("cannot be locked (") + std::strerror(errno) + ")";
  close(file);
  throw bad_input(locked, fault,
                  is_held ? "wait for it or end it" : "choose a place whose files can be locked");
}

bool is_same_file(int file, const std::filesystem::path& path) {
  struct stat held {};
  struct stat named {};
  return fstat(file, &held) == 0 && lstat(path.c_str(), &named) == 0 &&
         held.st_dev == named.st_dev && held.st_ino == named.st_ino;
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder)
    : FolderLock(folder / ".lock", folder) {}

FolderLock FolderLock::of_file(const std::filesystem::path& file) {
  std::filesystem::path name(".");
  name += file.filename();
  name += ".lock";
  return {std::filesystem::absolute(file).parent_path() / name, file};
}

FolderLock::FolderLock(std::filesystem::path lock, const std::filesystem::path& locked)
    : path_(std::move(lock)) {
  std::error_code failure;
  std::filesystem::create_directories(path_.parent_path(), failure);
  // Its last holder may remove the file between these two: then what is held is no lock.
  do {
    if (file_ >= 0) close(file_);
    file_ = open_file(path_);
    hold(file_, locked);
  } while (!is_same_file(file_, path_));
  // Only for people: on a full disk the lock holds all the same.
  const std::string holder = this_process() + "\n";
  if (ftruncate(file_, 0) != 0 ||
      pwrite(file_, holder.data(), holder.size(), 0) != static_cast<ssize_t>(holder.size())) {
    return;
  }
}

FolderLock::~FolderLock() {
  std::error_code failure;
  std::filesystem::remove(path_, failure);
  close(file_);
}

}  // namespace sheen::core
