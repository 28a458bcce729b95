// SPDX-License-Identifier: MIT
#pragma once

#include "app/command_line/command_line.h"
#include "app/commands/walk_session.h"
#include "pipeline/options.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace sheen::app {

/// Which of the agreeing implementations finds hidden vertices; `automatic` is the fastest.
enum class VisibilityMethod { automatic, raster, rays, depth };

/// Everything `sheen replay` may be asked.
struct ReplayOptions {
  std::filesystem::path session;       ///< or a video, or a folder of pictures
  std::filesystem::path new_session;   ///< made of a video or pictures; empty: named as the model
  WalkOptions walk;                    ///< what a session that lacks it takes
  std::filesystem::path output;        ///< the model
  std::filesystem::path mean_output;   ///< the mean colours as a model; empty: not written
  std::filesystem::path mesh_output;   ///< the refined mesh, PLY; empty: not written
  std::filesystem::path state_output;  ///< what the fit can go on from; empty: not written
  std::filesystem::path poses_output;  ///< estimated poses, TUM form; empty: not written
  pipeline::ReconstructionOptions reconstruction;
  VisibilityMethod visibility = VisibilityMethod::automatic;
  std::string note;                       ///< what was not chosen as usual and why; empty: nothing
  bool preview = false;                   ///< watched in a window
  std::filesystem::path snapshots = ".";  ///< folder for the window's snapshots
};

/// The part of them that says what becomes of frames, live ones too.
void add_model_options(Command command, ReplayOptions& options);

void add_replay_options(Command command, ReplayOptions& options);

/// The options as they stand in reports, those of the representation that runs among them.
nlohmann::ordered_json to_json(const ReplayOptions& options);

}  // namespace sheen::app
