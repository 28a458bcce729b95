// SPDX-License-Identifier: MIT
#include "tests/app/display.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <stdexcept>

namespace sheen::tests {
namespace {

/// Starts a program, its messages dropped; ends with 127 when it cannot be started.
pid_t start(const std::vector<std::string>& words) {
  const pid_t child = fork();
  if (child != 0) return child;
  const int nowhere = ::open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  execvp(arguments[0], arguments.data());
  _exit(127);
}

int wait_for(pid_t child) {
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

std::unique_ptr<VirtualDisplay> VirtualDisplay::open(int width_px, int height_px) {
  if (wait_for(start({"sh", "-c", "command -v Xvfb && command -v xdotool"})) != 0) return nullptr;
  // The server writes the number of its display into a pipe once it listens.
  std::array<int, 2> pipe_ends{};
  if (pipe(pipe_ends.data()) != 0) return nullptr;
  const std::string size = std::to_string(width_px) + "x" + std::to_string(height_px) + "x24";
  const pid_t server = start({"Xvfb", "-displayfd", std::to_string(pipe_ends[1]), "-screen", "0",
                              size, "-nolisten", "tcp"});
  close(pipe_ends[1]);
  std::string number;
  for (char digit = 0; read(pipe_ends[0], &digit, 1) == 1 && digit != '\n';) number += digit;
  close(pipe_ends[0]);
  auto display = std::unique_ptr<VirtualDisplay>(new VirtualDisplay(server));
  if (number.empty()) return nullptr;
  setenv("DISPLAY", (":" + number).c_str(), 1);
  return display;
}

VirtualDisplay::~VirtualDisplay() {
  kill(server_, SIGTERM);
  wait_for(server_);
}

void VirtualDisplay::act(const std::vector<std::string>& arguments) const {
  std::vector<std::string> words{"xdotool"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  if (wait_for(start(words)) != 0) throw std::runtime_error("xdotool failed");
}

}  // namespace sheen::tests

/// The address sanitizer's: leaks are looked for when the window system's driver has been unloaded
/// and its own can no longer be told from ours.
// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming)
extern "C" const char* __asan_default_options();
extern "C" const char* __asan_default_options() {
  return "detect_leaks=0";
}
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)
