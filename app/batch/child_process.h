// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace sheen::app {

/// Another program, or another run of this one. It is asked to end when its owner goes or dies.
class ChildProcess {
 public:
  /// Starts `program` (found as a shell finds it) with `arguments`; both streams are added to the
  /// file `log`. Throws core::Error (run_failed); a program that is not there ends with exit code
  /// 127. To be called on a thread that lives as long as the process is wanted: with it the process
  /// is asked to end.
  ChildProcess(const std::string& program, const std::vector<std::string>& arguments,
               const std::filesystem::path& log);
  ~ChildProcess();
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&&) = delete;
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Becomes readable when the process has ended.
  [[nodiscard]] int handle() const { return handle_; }

  /// How it ended (docs/commands.md; 128 + signal when one ended it); nothing while it runs.
  std::optional<int> exit_code();

  /// SIGINT, as Ctrl-C sends it. Not to be called once it has ended.
  void interrupt() const;

 private:
  pid_t process_ = -1;
  int handle_ = -1;
};

}  // namespace sheen::app
