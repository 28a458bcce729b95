// SPDX-License-Identifier: MIT
#include "reconstruction/live/live_hull.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace sheen::reconstruction {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kRestPerWork = 3;
constexpr std::chrono::milliseconds kShortestRest{300};

}  // namespace

LiveHull::LiveHull(const LiveWalk& walk, std::filesystem::path session)
    : walk_(walk),
      thread_([this, hull = GrowingHull(std::move(session))](const std::stop_token& stop) mutable {
        run(stop, std::move(hull));
      }) {}

GrowingHull::News LiveHull::news() const {
  const std::lock_guard lock(mutex_);
  return news_;
}

void LiveHull::run(const std::stop_token& stop, GrowingHull hull) {
  while (!stop.stop_requested()) {
    const auto begin = Clock::now();
    const auto views = walk_.views();
    const bool is_new = views && hull.step(*views);
    std::unique_lock lock(mutex_);
    if (is_new) news_ = hull.news();
    const auto rest =
        std::max<Clock::duration>(kRestPerWork * (Clock::now() - begin), kShortestRest);
    wake_.wait_for(lock, stop, rest, [] { return false; });
  }
}

}  // namespace sheen::reconstruction
