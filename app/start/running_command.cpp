// SPDX-License-Identifier: MIT
#include "app/start/running_command.h"

#include "core/diagnostics/error.h"

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <utility>

namespace sheen::app {
namespace {

namespace fs = std::filesystem;

/// The program itself, wherever it was started from.
std::string this_program() {
  std::error_code no_throw;
  const fs::path program = fs::read_symlink("/proc/self/exe", no_throw);
  return program.empty() ? "sheen" : program.string();
}

fs::path new_log() {
  std::string name = (fs::temp_directory_path() / "sheen-XXXXXX").string();
  const int file = mkstemp(name.data());
  if (file < 0) {
    throw core::Error(core::Error::Kind::run_failed, fs::temp_directory_path(),
                      "takes no temporary file", "check free space and permissions");
  }
  close(file);
  return name;
}

bool is_program(const fs::path& file) {
  return access(file.c_str(), X_OK) == 0;
}

bool is_installed(const std::string& program) {
  const char* const path = std::getenv("PATH");
  std::string folder;
  for (const char* c = path == nullptr ? "" : path;; ++c) {
    if (*c != ':' && *c != '\0') {
      folder += *c;
      continue;
    }
    if (!folder.empty() && is_program(fs::path(folder) / program)) return true;
    folder.clear();
    if (*c == '\0') return false;
  }
}

}  // namespace

RunningCommand::RunningCommand(Arguments arguments)
    : arguments_(std::move(arguments)), log_(new_log()) {
  process_.emplace(this_program(), arguments_, log_);
}

RunningCommand::~RunningCommand() {
  process_.reset();
  std::error_code no_throw;
  fs::remove(log_, no_throw);
}

std::string RunningCommand::last_words() const {
  std::ifstream log(log_);
  std::string last;
  for (std::string line; std::getline(log, line);) {
    if (!line.empty()) last = line;
  }
  return last;
}

std::optional<int> RunningCommand::exit_code() {
  if (!exit_code_) exit_code_ = process_->exit_code();
  return exit_code_;
}

void RunningCommand::interrupt() {
  if (!exit_code()) process_->interrupt();
}

bool show_on_desktop(const fs::path& file) {
  if (!is_installed("xdg-open")) return false;
  const pid_t child = fork();
  if (child == 0) {
    // A grandchild, so that nobody has to wait for the viewer.
    if (fork() == 0) {
      execlp("xdg-open", "xdg-open", file.c_str(), static_cast<char*>(nullptr));
      _exit(127);
    }
    _exit(0);
  }
  return child > 0 && waitpid(child, nullptr, 0) == child;
}

}  // namespace sheen::app
