// SPDX-License-Identifier: MIT
#include "app/preview/panel_words.h"

#include "app/preview/theme.h"

#include <algorithm>

namespace sheen::app {

void text(const ImVec4& colour, const std::string& words) {
  ImGui::PushStyleColor(ImGuiCol_Text, colour);
  ImGui::TextUnformatted(words.c_str());
  ImGui::PopStyleColor();
}

void wrapped(const ImVec4& colour, const std::string& words) {
  ImGui::PushTextWrapPos(0);
  text(colour, words);
  ImGui::PopTextWrapPos();
}

void gap(float lines) {
  ImGui::Dummy({0, lines * ImGui::GetFontSize()});
}

void row(const std::string& name, const std::string& value, const ImVec4& colour) {
  text(theme::kQuiet, name);
  const float width = ImGui::CalcTextSize(value.c_str()).x;
  ImGui::SameLine(std::max(ImGui::GetContentRegionMax().x - width, 0.0f));
  text(colour, value);
}

void heading(const std::string& words) {
  gap(0.4f);
  text(theme::kText, words);
  const ImVec2 from = ImGui::GetCursorScreenPos();
  ImGui::GetWindowDrawList()->AddLine({from.x, from.y - 2},
                                      {from.x + ImGui::GetContentRegionAvail().x, from.y - 2},
                                      ImGui::GetColorU32(theme::kRaised));
  ImGui::Dummy({0, 2});
}

}  // namespace sheen::app
