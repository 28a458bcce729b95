// SPDX-License-Identifier: MIT
#include "app/preview/theme.h"

#include <array>
#include <cmath>
#include <filesystem>

namespace sheen::app::theme {
namespace {

constexpr float kText_px = 15.0f;
constexpr float kLarge_px = 26.0f;

struct Typeface {
  const char* regular;
  const char* large;
};
// fonts-inter, then fonts-dejavu-core.
constexpr std::array kTypefaces{Typeface{"/usr/share/fonts/opentype/inter/Inter-Regular.otf",
                                         "/usr/share/fonts/opentype/inter/InterDisplay-Medium.otf"},
                                Typeface{"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                                         "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"}};
// Latin and the few signs that the panels use: dashes, degrees, arrows.
constexpr std::array<ImWchar, 9> kGlyphs{0x20,   0xff,   0x2010, 0x2026, 0x2190,
                                         0x2193, 0x2212, 0x2212, 0};

void set_colours(ImGuiStyle& style) {
  ImGui::StyleColorsDark(&style);
  const ImVec4 clear{0, 0, 0, 0};
  const ImVec4 lifted{0.235f, 0.251f, 0.282f, 1.0f};
  auto& colours = style.Colors;
  colours[ImGuiCol_Text] = kText;
  colours[ImGuiCol_TextDisabled] = kQuiet;
  colours[ImGuiCol_WindowBg] = kPanel;
  colours[ImGuiCol_ChildBg] = clear;
  colours[ImGuiCol_PopupBg] = kPanel;
  colours[ImGuiCol_Border] = kRaised;
  colours[ImGuiCol_FrameBg] = kRaised;
  colours[ImGuiCol_FrameBgHovered] = lifted;
  colours[ImGuiCol_FrameBgActive] = lifted;
  colours[ImGuiCol_Button] = kRaised;
  colours[ImGuiCol_ButtonHovered] = lifted;
  colours[ImGuiCol_ButtonActive] = ImVec4{0.29f, 0.31f, 0.35f, 1.0f};
  colours[ImGuiCol_Header] = kRaised;
  colours[ImGuiCol_HeaderHovered] = lifted;
  colours[ImGuiCol_HeaderActive] = lifted;
  colours[ImGuiCol_CheckMark] = kAccent;
  colours[ImGuiCol_PlotLines] = kAccent;
  colours[ImGuiCol_PlotHistogram] = kAccent;
  colours[ImGuiCol_Separator] = kRaised;
  colours[ImGuiCol_ScrollbarBg] = clear;
}

void set_spacing(ImGuiStyle& style, float content_scale) {
  style.WindowRounding = 0;
  style.FrameRounding = 4;
  style.PopupRounding = 6;
  style.GrabRounding = 4;
  style.WindowBorderSize = 0;
  style.FrameBorderSize = 0;
  style.WindowPadding = {18, 16};
  style.FramePadding = {10, 5};
  style.ItemSpacing = {8, 5};
  style.ItemInnerSpacing = {8, 4};
  style.ScrollbarSize = 10;
  style.ScaleAllSizes(content_scale);
}

ImFont* load(const char* file, float size_px) {
  std::error_code unreadable;
  if (!std::filesystem::is_regular_file(file, unreadable)) return nullptr;
  ImFontConfig config;
  config.OversampleH = 2;
  return ImGui::GetIO().Fonts->AddFontFromFileTTF(file, size_px, &config, kGlyphs.data());
}

Fonts load_fonts(float content_scale) {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  atlas.Clear();
  for (const Typeface& typeface : kTypefaces) {
    Fonts fonts{load(typeface.regular, std::round(kText_px * content_scale)), nullptr};
    if (fonts.text == nullptr) continue;
    fonts.large = load(typeface.large, std::round(kLarge_px * content_scale));
    if (fonts.large == nullptr) fonts.large = fonts.text;
    return fonts;
  }
  ImFontConfig config;
  config.SizePixels = std::round(13 * content_scale);
  ImFont* const builtin = atlas.AddFontDefault(&config);
  return {builtin, builtin};
}

}  // namespace

Fonts apply(float content_scale) {
  ImGuiStyle& style = ImGui::GetStyle();
  style = ImGuiStyle();
  set_colours(style);
  set_spacing(style, content_scale);
  return load_fonts(content_scale);
}

}  // namespace sheen::app::theme
