// SPDX-License-Identifier: MIT
#include "app/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace sheen::app {
namespace {
constexpr int kBarWidth = 30;
constexpr int kPlainLines = 10;
constexpr auto kRedrawInterval = std::chrono::milliseconds(50);
}  // namespace

Progress::Progress(std::string what, int total, bool quiet)
    : what_(std::move(what)), total_(total), quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (drawn_) std::fputc('\n', stderr);
}

void Progress::show(int done, const std::string& note) {
  if (quiet_) return;
  if (terminal_) {
    // Redraw seldom enough not to cost anything, but always at the end.
    const auto now = Clock::now();
    if (done != total_ && now - last_draw_ < kRedrawInterval) return;
    last_draw_ = now;
    draw_bar(done, note);
    drawn_ = true;
    return;
  }
  // A line for every tenth of the work, the last one at its end.
  const int step = std::max(1, ((total_ > 0 ? total_ : 1000) + kPlainLines - 1) / kPlainLines);
  if (done < last_line_ + step && done != total_) return;
  last_line_ = done;
  const std::string of_total = total_ > 0 ? fmt::format("/{}", total_) : "";
  fmt::print(stderr, "{} {}{}{}{}\n", what_, done, of_total, note.empty() ? "" : ", ", note);
}

void Progress::draw_bar(int done, const std::string& note) const {
  if (total_ <= 0) {
    fmt::print(stderr, "\r{} {}  {}\x1b[K", what_, done, note);
  } else {
    const int filled = std::clamp(done * kBarWidth / total_, 0, kBarWidth);
    fmt::print(stderr, "\r{} [{}{}] {}/{}  {}{}\x1b[K", what_, std::string(filled, '='),
               std::string(kBarWidth - filled, ' '), done, total_, time_left(done), note);
  }
  std::fflush(stderr);
}

std::string Progress::time_left(int done) const {
  if (done <= 0 || done >= total_) return "";
  const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
  return fmt::format("{:.0f} s left  ", elapsed * (total_ - done) / done);
}

}  // namespace sheen::app
