// SPDX-License-Identifier: MIT
// Loaded before a program (LD_PRELOAD), this lets its disk fail, as SQLite's testers do. What
// counts are writes to regular files (but for stderr), and, for kills, renames:
//   SHEEN_FAULT=full:N    the N-th write and all later ones fail with ENOSPC
//   SHEEN_FAULT=short:N   the N-th write takes half of what it is given, later ones fail
//   SHEEN_FAULT=kill:N    the process dies by SIGKILL before the N-th write or rename
#include <dlfcn.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

enum class Fault { none, full, half, kill };

struct Plan {
  Fault fault = Fault::none;
  long at = 0;
};

Plan plan() {
  const char* text = std::getenv("SHEEN_FAULT");
  if (text == nullptr) return {};
  const char* colon = std::strchr(text, ':');
  if (colon == nullptr) return {};
  const long at = std::strtol(colon + 1, nullptr, 10);
  if (std::strncmp(text, "full", 4) == 0) return {Fault::full, at};
  if (std::strncmp(text, "short", 5) == 0) return {Fault::half, at};
  return {Fault::kill, at};
}

std::atomic<long> events{0};

bool counts(int file) {
  struct stat status {};
  return file != STDERR_FILENO && fstat(file, &status) == 0 && S_ISREG(status.st_mode);
}

enum class Fate { done, shortened, refused };

Fate next_event(bool is_rename) {
  static const Plan the_plan = plan();
  if (the_plan.fault == Fault::none || (is_rename && the_plan.fault != Fault::kill)) {
    return Fate::done;
  }
  const long event = ++events;
  if (event < the_plan.at) return Fate::done;
  if (the_plan.fault == Fault::kill) std::raise(SIGKILL);
  if (the_plan.fault == Fault::half && event == the_plan.at) return Fate::shortened;
  errno = ENOSPC;
  return Fate::refused;
}

template <typename Function>
Function* real(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

Fate fate_of_write(int file) {
  return counts(file) ? next_event(false) : Fate::done;
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

size_t fwrite(const void* bytes, size_t size, size_t count, FILE* file) {
  static auto* const original = real<size_t(const void*, size_t, size_t, FILE*)>("fwrite");
  const Fate fate = fate_of_write(fileno(file));
  if (fate == Fate::refused) return 0;
  return original(bytes, size, fate == Fate::shortened ? count / 2 : count, file);
}

int rename(const char* from, const char* to) {
  static auto* const original = real<int(const char*, const char*)>("rename");
  next_event(true);
  return original(from, to);
}

}  // extern "C"
