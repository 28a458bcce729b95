// SPDX-License-Identifier: MIT
#pragma once

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

}  // namespace sheen::app::layout
