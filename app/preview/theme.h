// SPDX-License-Identifier: MIT
#pragma once

#include <imgui.h>

namespace sheen::app::theme {

// Quiet greys, one accent; warm colours are kept for what wants attention.
inline const ImVec4 kBackground{0.098f, 0.106f, 0.118f, 1.0f};
inline const ImVec4 kPanel{0.129f, 0.137f, 0.153f, 1.0f};
inline const ImVec4 kRaised{0.188f, 0.200f, 0.224f, 1.0f};
inline const ImVec4 kText{0.890f, 0.898f, 0.910f, 1.0f};
inline const ImVec4 kQuiet{0.573f, 0.596f, 0.635f, 1.0f};
inline const ImVec4 kAccent{0.357f, 0.675f, 0.812f, 1.0f};
inline const ImVec4 kGood{0.482f, 0.749f, 0.549f, 1.0f};
inline const ImVec4 kWarning{0.914f, 0.706f, 0.341f, 1.0f};
inline const ImVec4 kAlarm{0.890f, 0.420f, 0.408f, 1.0f};

/// Fonts of the window; both live as long as ImGui's context.
struct Fonts {
  ImFont* text = nullptr;
  ImFont* large = nullptr;
};

/// Sets colours, spacing and fonts for a content scale (1 = 96 dpi). May be called again when the
/// scale changes; fonts are then rebuilt. Needs ImGui's context.
Fonts apply(float content_scale);

}  // namespace sheen::app::theme
