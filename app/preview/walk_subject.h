// SPDX-License-Identifier: MIT
#pragma once

#include "app/walk/walk_model.h"
#include "reconstruction/live/live_hull.h"
#include "reconstruction/live/live_walk.h"

#include <filesystem>
#include <string>

namespace sheen::app {

/// What the window of a walk is opened for; what is pointed to outlives it.
struct WalkSubject {
  std::string title;
  const reconstruction::LiveWalk& walk;
  const reconstruction::LiveHull& hull;
  const WalkModel* model = nullptr;  ///< null: no light field before the recording has ended
  std::filesystem::path snapshot_folder = {};
};

}  // namespace sheen::app
