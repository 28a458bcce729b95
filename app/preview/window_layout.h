// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/camera.h"

#include <imgui.h>

namespace sheen::app::layout {

inline constexpr int kWidth = 1280;
inline constexpr int kHeight = 720;
inline constexpr float kPanelWidth = 292;    // in units of the content scale
inline constexpr float kInsetWidth = 0.34f;  // of the large view
inline constexpr float kMargin = 14;         // in units of the content scale

/// Parts of the window that stay where they are.
inline constexpr ImGuiWindowFlags kFixed =
    ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
    ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNav;

/// Corner and size of a part, pixels.
struct Area {
  ImVec2 corner, size;
};

/// The display without the panel at its right, and the panel. `scale` is that of the contents.
Area views_area(float scale);
Area panel_area(float scale);
/// Begin the ImGui windows of both; ImGui::End() ends them.
void begin_views(const Area& area);
void begin_panel(const Area& area);

/// The lower left corner of the views, for an image of the lens's proportions, and a frame round
/// it.
Area inset_area(const Area& views, const core::CameraModel& lens, float scale);
void frame_inset(const Area& inset, float scale);

}  // namespace sheen::app::layout
