// SPDX-License-Identifier: MIT
#include "app/preview/window_layout.h"

#include "app/preview/theme.h"

#include <algorithm>

namespace sheen::app::layout {
namespace {

float panel_width(float scale) {
  return std::min(kPanelWidth * scale, 0.5f * ImGui::GetIO().DisplaySize.x);
}

void begin(const char* name, const Area& area, ImGuiWindowFlags flags) {
  ImGui::SetNextWindowPos(area.corner);
  ImGui::SetNextWindowSize(area.size);
  ImGui::Begin(name, nullptr, flags);
}

}  // namespace

Area views_area(float scale) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  return {{0, 0}, {display.x - panel_width(scale), display.y}};
}

Area panel_area(float scale) {
  const float width = panel_width(scale);
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  return {{display.x - width, 0}, {width, display.y}};
}

void begin_views(const Area& area) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2{0, 0});
  begin("views", area, kFixed | ImGuiWindowFlags_NoScrollWithMouse | ImGuiWindowFlags_NoBackground);
  ImGui::PopStyleVar();
}

void begin_panel(const Area& area) {
  begin("panel", area, kFixed & ~ImGuiWindowFlags_NoScrollbar);
}

Area inset_area(const Area& views, const core::CameraModel& lens, float scale) {
  const float width = kInsetWidth * views.size.x;
  const float height =
      width * static_cast<float>(lens.height_px()) / static_cast<float>(lens.width_px());
  const float margin = kMargin * scale;
  return {{margin, views.size.y - margin - height}, {width, height}};
}

void frame_inset(const Area& inset, float scale) {
  const ImVec2 end(inset.corner.x + inset.size.x, inset.corner.y + inset.size.y);
  ImGui::GetWindowDrawList()->AddRect(inset.corner, end, ImGui::GetColorU32(theme::kRaised), 0, 0,
                                      1.5f * scale);
}

}  // namespace sheen::app::layout
