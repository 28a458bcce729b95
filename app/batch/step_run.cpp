// SPDX-License-Identifier: MIT
#include "app/batch/step_run.h"

#include "core/text/number.h"

#include <cstring>
#include <fstream>

namespace sheen::app {
namespace {

constexpr const char* kLog = "log.txt";
constexpr std::size_t kLongestMessage = 400;

/// The program's last line, which says what went wrong.
std::string last_line(const std::filesystem::path& log) {
  std::ifstream file(log);
  std::string last;
  for (std::string line; std::getline(file, line);) {
    if (!line.empty()) last = line;
  }
  if (last.starts_with("sheen: ")) last.erase(0, std::strlen("sheen: "));
  return core::quotable(last, kLongestMessage);
}

std::string message(int exit_code, const std::filesystem::path& log) {
  if (exit_code > 128 && exit_code != 130) {
    return "was ended by signal " + std::to_string(exit_code - 128) + " (" +
           strsignal(exit_code - 128) + ")";
  }
  const std::string said = last_line(log);
  return said.empty() ? "ended with exit code " + std::to_string(exit_code) : said;
}

}  // namespace

StepRun::StepRun(const SessionWork& work, Step step, int threads)
    : work_(work), step_(step), made_from_(work.fingerprint(step)), output_(work.folder_of(step)) {
  std::filesystem::create_directory(output_.path());
  child_.emplace("/proc/self/exe", work.prepare(step, output_.path(), threads),
                 output_.path() / kLog);
}

StepRun::State StepRun::state() {
  const auto exit_code = child_->exit_code();
  if (!exit_code) return State::running;
  if (*exit_code != 0) {
    failure_ = {std::string(name_of(step_)), message(*exit_code, output_.path() / kLog)};
    write_failure(work_.folder(), failure_, output_.path() / kLog);
    return State::failed;
  }
  const std::chrono::duration<double> elapsed = Clock::now() - start_;
  SessionWork::record(step_, output_.path(), made_from_, elapsed.count());
  output_.commit();
  remove_failure(work_.folder());
  return State::done;
}

}  // namespace sheen::app
