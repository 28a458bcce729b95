// SPDX-License-Identifier: MIT
#include "tests/app/program.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <stdexcept>

extern char** environ;  // NOLINT: POSIX's own name

namespace sheen::tests {

ProgramRun run_sheen(const std::vector<std::string>& arguments) {
  const TemporaryFolder folder;
  const auto out = folder.path() / "out";
  const auto err = folder.path() / "err";

  // Spawn with both streams sent to files, so that neither can fill a pipe and block.
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), O_CREAT | O_WRONLY, 0600);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.c_str(), O_CREAT | O_WRONLY, 0600);
  std::vector<std::string> words{SHEEN_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_t child = 0;
  const int failure = posix_spawn(&child, SHEEN_PROGRAM, &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failure != 0) throw std::runtime_error("cannot start " SHEEN_PROGRAM);

  int status = 0;
  waitpid(child, &status, 0);
  ProgramRun run;
  run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  run.standard_output = read_file(out);
  run.standard_error = read_file(err);
  return run;
}

const char* sheen_program() {
  return SHEEN_PROGRAM;
}

std::filesystem::path sample_session() {
  return std::filesystem::path(SHEEN_SOURCE_DIR) / "sample_data" / "glossy";
}

std::filesystem::path shared_session(const std::string& name) {
  const auto folder = std::filesystem::path(SHEEN_SHARED_DATA) / name;
  return std::filesystem::exists(folder / "session.json") ? folder : std::filesystem::path();
}

}  // namespace sheen::tests
