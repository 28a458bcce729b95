// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <string>

namespace sheen::app {

/// Progress of long work on stderr: a bar with the time left on a terminal, a line every tenth of
/// the work otherwise. Used from one thread.
class Progress {
 public:
  /// `total` <= 0: unknown length, counts only.
  Progress(std::string what, int total, bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  Progress(Progress&&) = delete;
  Progress& operator=(Progress&&) = delete;

  /// `note` is shown behind the bar, e.g. "112 posed".
  void show(int done, const std::string& note = {});

 private:
  void draw_bar(int done, const std::string& note) const;
  [[nodiscard]] std::string time_left(int done) const;

  using Clock = std::chrono::steady_clock;
  std::string what_;
  int total_;
  bool quiet_;
  bool terminal_;
  bool drawn_ = false;
  int last_line_ = 0;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_draw_{};
};

}  // namespace sheen::app
