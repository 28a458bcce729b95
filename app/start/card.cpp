// SPDX-License-Identifier: MIT
#include "app/start/card.h"

#include "app/preview/panel_words.h"
#include "app/preview/window_layout.h"

namespace sheen::app {
namespace {

constexpr float kCardRounding = 8;  // in units of the content scale

/// Without its last code point of UTF-8.
void shorten(std::string& words) {
  const auto goes_on = [](char byte) {
    return (static_cast<unsigned char>(byte) & 0xc0U) == 0x80U;
  };
  while (words.size() > 1 && goes_on(words.back())) words.pop_back();
  words.pop_back();
}

}  // namespace

void begin_card(const char* name, const ImVec2& corner, const ImVec2& size, float scale) {
  ImGui::SetNextWindowPos(corner);
  ImGui::SetNextWindowSize(size);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, kCardRounding * scale);
  ImGui::Begin(name, nullptr, layout::kFixed & ~ImGuiWindowFlags_NoNav);
  ImGui::PopStyleVar();
}

void step_title(const char* number, const char* words, const theme::Fonts& fonts) {
  ImGui::PushFont(fonts.large);
  text(theme::kAccent, number);
  ImGui::SameLine();
  text(theme::kText, words);
  ImGui::PopFont();
}

CardFoot card_foot(const Arguments& arguments, int fields) {
  const ImGuiStyle& style = ImGui::GetStyle();
  const std::string command = as_typed("sheen", arguments);
  const float width = ImGui::GetContentRegionAvail().x;
  const float high = ImGui::CalcTextSize(command.c_str(), nullptr, false, width).y;
  CardFoot foot{};
  foot.button = ImGui::GetWindowHeight() - style.WindowPadding.y - ImGui::GetFrameHeight();
  foot.command = foot.button - 2 * style.ItemSpacing.y - high;
  foot.fields = foot.command - style.ItemSpacing.y -
                static_cast<float>(fields) * ImGui::GetFrameHeightWithSpacing();
  return foot;
}

float room_above(float y) {
  return y - ImGui::GetCursorPosY() - 2 * ImGui::GetStyle().ItemSpacing.y;
}

std::string fitted(std::string words, float width) {
  if (ImGui::CalcTextSize(words.c_str()).x <= width) return words;
  while (words.size() > 8 && ImGui::CalcTextSize((words + "\u2026").c_str()).x > width) {
    shorten(words);
  }
  return words + "\u2026";
}

}  // namespace sheen::app
