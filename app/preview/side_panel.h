// SPDX-License-Identifier: MIT
#pragma once

#include "app/preview/commands.h"
#include "app/preview/live_status.h"
#include "app/preview/preview_subject.h"
#include "app/preview/theme.h"
#include "app/preview/view_state.h"
#include "fitting/guidance/direction_cells.h"

#include <Eigen/Core>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace sheen::app {

/// The patch under the cursor.
struct PatchNews {
  std::uint32_t patch_idx = 0;
  Eigen::Vector2f present_uv;  ///< direction of the view on the patch's disc
  std::function<Eigen::Vector3f(const Eigen::Vector2f&)> colour_at;  ///< of a finished model
  std::optional<std::uint32_t> samples;                              ///< of a live one
  fitting::guidance::DirectionCells seen = 0;
  fitting::guidance::DirectionCells reachable = 0;
};

/// What the panel at the side shows.
struct PanelContents {
  const LiveStatus* live = nullptr;  ///< null for a finished model
  ModelFacts facts;                  ///< of a finished model
  double drawing_ms = 0;
};

/// Fills the present ImGui window; returns what was clicked.
std::vector<ViewCommand> show_side_panel(const PanelContents& contents, const ViewState& state,
                                         const theme::Fonts& fonts);

/// The buttons that choose a layer, with the legend of the one that is shown.
void show_layers(const ViewState& state, bool live, std::vector<ViewCommand>& clicks);

/// How much has been looked at, [0, 1]; 0: not known yet.
void show_coverage(double coverage, const theme::Fonts& fonts);

/// What is known of a patch, in a small window whose lower right corner is given.
void show_patch_card(const PatchNews& patch, const ImVec2& lower_right);

/// The keys, over everything else.
void show_help(bool live);

}  // namespace sheen::app
