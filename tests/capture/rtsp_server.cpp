// SPDX-License-Identifier: MIT
#include "tests/capture/rtsp_server.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <vector>

namespace sheen::capture::test {

RtspServer::RtspServer(const std::filesystem::path& video, bool has_password) {
  std::vector<std::string> words = {
      "/usr/bin/python3", SHEEN_SOURCE_DIR "/tests/capture/rtsp_server.py", video.string()};
  if (has_password) words.insert(words.end(), {"me", "secret"});
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);

  std::array<int, 2> to{}, from{};
  if (::pipe2(to.data(), O_CLOEXEC) != 0 || ::pipe2(from.data(), O_CLOEXEC) != 0) return;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, to[0], 0);
  posix_spawn_file_actions_adddup2(&actions, from[1], 1);
  posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
  if (posix_spawn(&process_, words[0].c_str(), &actions, nullptr, arguments.data(), environ) != 0) {
    process_ = -1;
  }
  posix_spawn_file_actions_destroy(&actions);
  ::close(to[0]);
  ::close(from[1]);
  input_ = to[1];
  std::string answer;  // a line; nothing when the server could not start
  char letter = 0;
  while (process_ > 0 && ::read(from[0], &letter, 1) == 1 && letter != '\n') answer += letter;
  port_ = std::atoi(answer.c_str());
  ::close(from[0]);
}

RtspServer::~RtspServer() {
  if (input_ >= 0) ::close(input_);
  if (process_ <= 0) return;
  ::kill(process_, SIGKILL);
  ::waitpid(process_, nullptr, 0);
}

std::string rtsp_address(int port, const std::string& user) {
  return "rtsp://" + user + "127.0.0.1:" + std::to_string(port) + "/video?token=secret";
}

}  // namespace sheen::capture::test
