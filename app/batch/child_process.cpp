// SPDX-License-Identifier: MIT
#include "app/batch/child_process.h"

#include "core/diagnostics/error.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <utility>

namespace sheen::app {
namespace {

constexpr int kCannotStart = 127;

/// Between fork and exec: what is called here is safe there.
[[noreturn]] void become(const char* program, char** argv, int log, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(kCannotStart);  // it died before it could be watched
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
  const int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
  if (dup2(nothing, STDIN_FILENO) < 0 || dup2(log, STDOUT_FILENO) < 0 ||
      dup2(log, STDERR_FILENO) < 0) {
    _exit(kCannotStart);
  }
  execvp(program, argv);
  _exit(kCannotStart);
}

}  // namespace

ChildProcess::ChildProcess(const std::string& program, const std::vector<std::string>& arguments,
                           const std::filesystem::path& log) {
  std::vector<std::string> words{program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const int file = open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (file < 0) {
    throw core::Error(core::Error::Kind::run_failed, log, "cannot be written",
                      "check free space and permissions");
  }
  const pid_t parent = getpid();
  process_ = fork();
  if (process_ == 0) become(program.c_str(), argv.data(), file, parent);
  close(file);
  handle_ = process_ > 0 ? static_cast<int>(syscall(SYS_pidfd_open, process_, 0)) : -1;
  if (handle_ < 0) {
    if (process_ > 0) {
      kill(process_, SIGTERM);
      waitpid(process_, nullptr, 0);
    }
    throw core::Error(core::Error::Kind::run_failed, program, "cannot be started",
                      "lower --jobs or the number of other programs");
  }
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : process_(std::exchange(other.process_, -1)), handle_(std::exchange(other.handle_, -1)) {}

ChildProcess::~ChildProcess() {
  if (process_ > 0) {
    kill(process_, SIGTERM);
    waitpid(process_, nullptr, 0);
  }
  if (handle_ >= 0) close(handle_);
}

std::optional<int> ChildProcess::exit_code() {
  int status = 0;
  if (waitpid(process_, &status, WNOHANG) != process_) return std::nullopt;
  process_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

void ChildProcess::interrupt() const {
  kill(process_, SIGINT);
}

}  // namespace sheen::app
