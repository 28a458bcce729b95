// SPDX-License-Identifier: MIT
// Loaded before a program (LD_PRELOAD), this lets its disk fail, as SQLite's testers do. What
// counts are writes to regular files (but for stderr), and, for kills, renames:
//   SHEEN_FAULT=full:N    the N-th write and all later ones fail with ENOSPC
//   SHEEN_FAULT=short:N   the N-th write takes half of what it is given, later ones fail
//   SHEEN_FAULT=kill:N    the process dies by SIGKILL before the N-th write or rename
//   SHEEN_FAULT=power:N   the power fails after the N-th rename, or else when the process ends:
//   what
//                         was written and not flushed (fsync, fdatasync) is gone, names stay
//   SHEEN_FAULT=read-only:DIR   nothing in DIR can be made, written, moved or removed (EROFS)
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <vector>

namespace {

enum class Fault { none, full, half, kill, power, read_only };

struct Plan {
  Fault fault = Fault::none;
  long at = 0;
  const char* folder = nullptr;
};

Plan plan() {
  const char* text = std::getenv("SHEEN_FAULT");
  if (text == nullptr) return {};
  const char* colon = std::strchr(text, ':');
  if (colon == nullptr) return {};
  const long at = std::strtol(colon + 1, nullptr, 10);
  if (std::strncmp(text, "full", 4) == 0) return {Fault::full, at};
  if (std::strncmp(text, "short", 5) == 0) return {Fault::half, at};
  if (std::strncmp(text, "power", 5) == 0) return {Fault::power, at};
  if (std::strncmp(text, "read-only", 9) == 0) return {Fault::read_only, 0, colon + 1};
  return {Fault::kill, at};
}

const Plan& the_plan() {
  static const Plan kept = plan();
  return kept;
}

std::atomic<long> events{0};

/// Files that were written, and how long they were when they were last safe. Their handles are kept
/// here, since their writers close them.
class Unflushed {
 public:
  void written(int file) {
    struct stat status {};
    if (the_plan().fault != Fault::power || fstat(file, &status) != 0) return;
    const std::lock_guard lock(mutex_);
    if (find(status) == files_.end()) files_.push_back({dup(file), status});
  }
  void flushed(int file) {
    struct stat status {};
    if (the_plan().fault != Fault::power || fstat(file, &status) != 0) return;
    const std::lock_guard lock(mutex_);
    const auto known = find(status);
    if (known == files_.end()) return;
    close(known->handle);
    files_.erase(known);
  }
  void lose() {
    const std::lock_guard lock(mutex_);
    for (const File& file : files_) {
      if (ftruncate(file.handle, file.safe.st_size) != 0) std::abort();
    }
  }

 private:
  struct File {
    int handle;
    struct stat safe;
  };
  std::vector<File>::iterator find(const struct stat& status) {
    auto file = files_.begin();
    while (file != files_.end() &&
           (file->safe.st_ino != status.st_ino || file->safe.st_dev != status.st_dev)) {
      ++file;
    }
    return file;
  }
  std::mutex mutex_;
  std::vector<File> files_;
};

/// Lives as long as the process: writers outlive what is static.
Unflushed& unflushed() {
  static auto* const files = new Unflushed;  // NOLINT
  return *files;
}

__attribute__((destructor)) void end() {
  if (the_plan().fault == Fault::power) unflushed().lose();
}

bool counts(int file) {
  struct stat status {};
  return file != STDERR_FILENO && fstat(file, &status) == 0 && S_ISREG(status.st_mode);
}

enum class Fate { done, shortened, refused };

Fate next_event(bool is_rename) {
  const Fault fault = the_plan().fault;
  if (fault == Fault::none || fault == Fault::read_only) return Fate::done;
  if (fault != Fault::kill && (fault == Fault::power) != is_rename) return Fate::done;
  const long event = ++events;
  if (event < the_plan().at) return Fate::done;
  if (fault == Fault::power) unflushed().lose();
  if (fault == Fault::kill || fault == Fault::power) std::raise(SIGKILL);
  if (fault == Fault::half && event == the_plan().at) return Fate::shortened;
  errno = ENOSPC;
  return Fate::refused;
}

template <typename Function>
Function* real(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

/// Whether a change of what lies at a path is refused; errno then says so.
bool is_read_only(const char* path) {
  if (the_plan().fault != Fault::read_only ||
      std::strncmp(path, the_plan().folder, std::strlen(the_plan().folder)) != 0) {
    return false;
  }
  errno = EROFS;
  return true;
}

Fate fate_of_write(int file) {
  if (!counts(file)) return Fate::done;
  unflushed().written(file);
  return next_event(false);
}

}  // namespace

extern "C" {

ssize_t write(int file, const void* bytes, size_t count) {
  static auto* const original = real<ssize_t(int, const void*, size_t)>("write");
  const Fate fate = fate_of_write(file);
  if (fate == Fate::refused) return -1;
  return original(file, bytes, fate == Fate::shortened ? (count + 1) / 2 : count);
}

ssize_t writev(int file, const struct iovec* parts, int count) {
  static auto* const original = real<ssize_t(int, const struct iovec*, int)>("writev");
  const Fate fate = fate_of_write(file);
  if (fate == Fate::refused) return -1;
  return original(file, parts, fate == Fate::shortened ? 1 : count);
}

ssize_t pwrite64(int file, const void* bytes, size_t count, off64_t at) {
  static auto* const original = real<ssize_t(int, const void*, size_t, off64_t)>("pwrite64");
  const Fate fate = fate_of_write(file);
  if (fate == Fate::refused) return -1;
  return original(file, bytes, fate == Fate::shortened ? (count + 1) / 2 : count, at);
}

ssize_t pwrite(int file, const void* bytes, size_t count, off_t at) {
  return pwrite64(file, bytes, count, at);
}

ssize_t sendfile(int to, int from, off_t* at, size_t count) {
  static auto* const original = real<ssize_t(int, int, off_t*, size_t)>("sendfile");
  return fate_of_write(to) == Fate::refused ? -1 : original(to, from, at, count);
}

size_t fwrite(const void* bytes, size_t size, size_t count, FILE* file) {
  static auto* const original = real<size_t(const void*, size_t, size_t, FILE*)>("fwrite");
  const Fate fate = fate_of_write(fileno(file));
  if (fate == Fate::refused) return 0;
  return original(bytes, size, fate == Fate::shortened ? count / 2 : count, file);
}

int open(const char* path, int flags, ...) {
  static auto* const original = real<int(const char*, int, ...)>("open");
  va_list more;
  va_start(more, flags);
  const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(more, mode_t) : 0;
  va_end(more);
  if ((flags & (O_WRONLY | O_RDWR | O_CREAT)) != 0 && is_read_only(path)) return -1;
  return original(path, flags, mode);
}

FILE* fopen64(const char* path, const char* mode) {
  static auto* const original = real<FILE*(const char*, const char*)>("fopen64");
  if (std::strpbrk(mode, "wa+") != nullptr && is_read_only(path)) return nullptr;
  return original(path, mode);
}

FILE* fopen(const char* path, const char* mode) {
  return fopen64(path, mode);
}

int access(const char* path, int mode) {
  static auto* const original = real<int(const char*, int)>("access");
  return (mode & W_OK) != 0 && is_read_only(path) ? -1 : original(path, mode);
}

int mkdir(const char* path, mode_t mode) {
  static auto* const original = real<int(const char*, mode_t)>("mkdir");
  struct stat there {};
  if (stat(path, &there) != 0 && is_read_only(path)) return -1;
  return original(path, mode);
}

int remove(const char* path) {
  static auto* const original = real<int(const char*)>("remove");
  return is_read_only(path) ? -1 : original(path);
}

int rename(const char* from, const char* to) {
  static auto* const original = real<int(const char*, const char*)>("rename");
  if (is_read_only(from) || is_read_only(to)) return -1;
  if (the_plan().fault != Fault::power) next_event(true);
  const int result = original(from, to);
  if (the_plan().fault == Fault::power) next_event(true);
  return result;
}

int fsync(int file) {
  static auto* const original = real<int(int)>("fsync");
  unflushed().flushed(file);
  return the_plan().fault == Fault::power ? 0
                                          : original(file);  // what it took is gone or not anyway
}

int fdatasync(int file) {
  static auto* const original = real<int(int)>("fdatasync");
  unflushed().flushed(file);
  return the_plan().fault == Fault::power ? 0 : original(file);
}

}  // extern "C"
