// SPDX-License-Identifier: MIT
#pragma once

#include "app/batch/child_process.h"
#include "app/start/start_commands.h"

#include <filesystem>
#include <optional>
#include <string>

namespace sheen::app {

/// One of the program's own commands, run as it would be typed.
class RunningCommand {
 public:
  /// Throws core::Error (run_failed) when it cannot be started.
  explicit RunningCommand(Arguments arguments);
  ~RunningCommand();
  RunningCommand(const RunningCommand&) = delete;
  RunningCommand& operator=(const RunningCommand&) = delete;
  RunningCommand(RunningCommand&&) = delete;
  RunningCommand& operator=(RunningCommand&&) = delete;

  [[nodiscard]] const Arguments& arguments() const { return arguments_; }
  /// The last line that it has said: its progress, or at its end why it failed.
  [[nodiscard]] std::string last_words() const;
  /// Nothing while it runs; then as docs/commands.md says.
  std::optional<int> exit_code();
  /// As Ctrl-C does: a capture stops recording and makes its model.
  void interrupt();

 private:
  Arguments arguments_;
  std::filesystem::path log_;
  std::optional<ChildProcess> process_;
  std::optional<int> exit_code_;
};

/// Lets the desktop show a file in the program that it has for it; false when there is no xdg-open.
bool show_on_desktop(const std::filesystem::path& file);

}  // namespace sheen::app
