// SPDX-License-Identifier: MIT
#pragma once

#include "reconstruction/live/growing_hull.h"
#include "reconstruction/live/live_walk.h"

#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <thread>

namespace sheen::reconstruction {

/// Lets the hull of a walk grow while it goes on, on a thread that rests three times as long as it
/// works: it takes a quarter of a core.
class LiveHull {
 public:
  /// `walk` is borrowed; `session` names it in doubts.
  LiveHull(const LiveWalk& walk, std::filesystem::path session);

  [[nodiscard]] GrowingHull::News news() const;

 private:
  void run(const std::stop_token& stop, GrowingHull hull);

  const LiveWalk& walk_;
  mutable std::mutex mutex_;  ///< of what follows
  GrowingHull::News news_;
  std::condition_variable_any wake_;
  std::jthread thread_;  ///< last: it uses all of the above
};

}  // namespace sheen::reconstruction
