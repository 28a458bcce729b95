// SPDX-License-Identifier: MIT
#include "app/preview/side_panel.h"

#include "app/preview/hemisphere_plot.h"
#include "app/preview/object_painter.h"
#include "app/preview/panel_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace sheen::app {
namespace {

using Clicks = std::vector<ViewCommand>;

void button(const char* label, ViewCommand command, float width, Clicks& clicks) {
  if (ImGui::Button(label, {width, 0})) clicks.push_back(command);
}

void layer_choice(const ViewState& state, bool live, Clicks& clicks) {
  constexpr std::array commands{ViewCommand::show_radiance, ViewCommand::show_needs_views,
                                ViewCommand::show_misfit, ViewCommand::show_mesh};
  const float width = 0.5f * (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x);
  int shown = 0;
  for (std::size_t i = 0; i < kLayers.size(); ++i) {
    const bool is_score = kLayers[i] == Layer::needs_views || kLayers[i] == Layer::misfit;
    if (is_score && !live) continue;
    const bool chosen = state.layer == kLayers[i];
    if (chosen) {
      ImGui::PushStyleColor(ImGuiCol_Button, ImVec4{0.22f, 0.37f, 0.44f, 1});
      ImGui::PushStyleColor(ImGuiCol_ButtonHovered, ImVec4{0.25f, 0.41f, 0.49f, 1});
    }
    if (shown++ % 2 == 1) ImGui::SameLine();
    button(std::string(name_of(kLayers[i])).c_str(), commands[i], width, clicks);
    if (chosen) ImGui::PopStyleColor(2);
  }
}

/// A square of a colour and what it means.
void swatch(const std::array<float, 3>& colour, const std::string& words) {
  const ImVec2 from = ImGui::GetCursorScreenPos();
  const float side = 0.8f * ImGui::GetFontSize();
  ImGui::GetWindowDrawList()->AddRectFilled(
      from, {from.x + side, from.y + side},
      ImGui::GetColorU32({colour[0], colour[1], colour[2], 1}));
  ImGui::Dummy({side, side});
  ImGui::SameLine();
  text(theme::kQuiet, words);
}

/// Colours of the chosen score, what its ends mean, and the colour of what is not on it.
void legend(Layer layer) {
  if (layer != Layer::needs_views && layer != Layer::misfit) return;
  const auto scale = scale_of(layer);
  const auto colour = [&](std::size_t i) {
    return ImGui::GetColorU32({scale[i][0], scale[i][1], scale[i][2], 1});
  };
  const ImVec2 from = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  const float height = 0.45f * ImGui::GetFontSize();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  for (std::size_t half = 0; half < 2; ++half) {
    const float x = from.x + 0.5f * width * static_cast<float>(half);
    list.AddRectFilledMultiColor({x, from.y}, {x + 0.5f * width, from.y + height}, colour(half),
                                 colour(half + 1), colour(half + 1), colour(half));
  }
  ImGui::Dummy({width, height});
  const bool views = layer == Layer::needs_views;
  row(views ? "enough views" : "fits", views ? "more views needed" : "error 12 %", theme::kQuiet);
  swatch(unseen_colour(), "never seen");
}

void phase_line(const LiveStatus& live, const theme::Fonts& fonts) {
  const auto [words, colour] = [&]() -> std::pair<const char*, ImVec4> {
    switch (live.phase) {
      case LiveStatus::Phase::paused:
        return {"Paused", theme::kWarning};
      case LiveStatus::Phase::undoing:
        return {"Taking back", theme::kWarning};
      case LiveStatus::Phase::finished:
        return {"Finished", theme::kGood};
      case LiveStatus::Phase::running:
        break;
    }
    return {"Capturing", theme::kText};
  }();
  ImGui::PushFont(fonts.large);
  text(colour, words);
  ImGui::PopFont();
  if (live.phase == LiveStatus::Phase::finished) return;
  if (!live.trouble.empty()) {
    wrapped(theme::kAlarm, live.trouble);
  } else if (live.phase == LiveStatus::Phase::paused) {
    wrapped(theme::kQuiet, "Nothing is taken in until you go on");
  } else if (live.is_flat) {
    wrapped(theme::kGood, "Quality no longer rises: you may stop");
  } else {
    wrapped(theme::kQuiet, live.hint ? "Follow the amber arrow" : "Looking round");
  }
}

void quality_curve(const LiveStatus& live) {
  if (live.psnr_db.size() < 2) return;
  heading("Prediction of new frames");
  const auto [low, high] = std::ranges::minmax(live.psnr_db);
  ImGui::PushStyleColor(ImGuiCol_FrameBg, ImVec4{0, 0, 0, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2{0, 2});
  ImGui::PlotLines("##quality", live.psnr_db.data(), static_cast<int>(live.psnr_db.size()), 0,
                   nullptr, low - 0.5f, high + 0.5f,
                   {ImGui::GetContentRegionAvail().x, 2.7f * ImGui::GetFontSize()});
  ImGui::PopStyleVar();
  ImGui::PopStyleColor();
  row("before it was taken in", fmt::format("{:.1f} dB", live.psnr_db.back()));
}

void frame_counts(const LiveStatus& live) {
  heading("Frames");
  row("read", fmt::format("{}", live.frames_read));
  row("in the model", fmt::format("{}", live.frames_fitted));
  if (live.frames_undone > 0) row("taken back", fmt::format("{}", live.frames_undone));
  for (const auto& [reason, count] : live.refusals) {
    wrapped(theme::kWarning, fmt::format("{}  {}", count, reason));
  }
}

void stage_times(const LiveStatus& live, double drawing_ms) {
  heading("Milliseconds a frame");
  for (const auto& [stage, ms] : live.stage_ms) row(stage, fmt::format("{:.1f}", ms));
  row("drawing", fmt::format("{:.1f}", drawing_ms));
}

void live_buttons(const LiveStatus& live, Clicks& clicks) {
  const bool paused = live.phase == LiveStatus::Phase::paused;
  const float width = 0.5f * (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x);
  ImGui::BeginDisabled(live.phase == LiveStatus::Phase::finished);
  button(paused ? "Go on" : "Pause", ViewCommand::pause, width, clicks);
  ImGui::SameLine();
  button("Undo 5 s", ViewCommand::undo, width, clicks);
  button("Save", ViewCommand::save, width, clicks);
  ImGui::EndDisabled();
  ImGui::SameLine();
  button("Snapshot", ViewCommand::snapshot, width, clicks);
  if (!live.note.empty()) wrapped(theme::kQuiet, live.note);
}

}  // namespace

void show_layers(const ViewState& state, bool live, std::vector<ViewCommand>& clicks) {
  heading("Show");
  layer_choice(state, live, clicks);
  legend(state.layer);
}

void show_coverage(double coverage, const theme::Fonts& fonts) {
  heading("Directions looked from");
  ImGui::PushFont(fonts.large);
  // Nothing is known before the planner has looked from everywhere once.
  text(theme::kText, coverage > 0 ? fmt::format("{:.0f} %", 100 * coverage) : "\u2013");
  ImGui::PopFont();
  const ImVec2 from = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  const float height = 0.4f * ImGui::GetFontSize();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(from, {from.x + width, from.y + height}, ImGui::GetColorU32(theme::kRaised),
                     0.5f * height);
  if (coverage > 0.01) {
    list.AddRectFilled(from, {from.x + width * static_cast<float>(coverage), from.y + height},
                       ImGui::GetColorU32(theme::kAccent), 0.5f * height);
  }
  ImGui::Dummy({width, height});
}

std::vector<ViewCommand> show_side_panel(const PanelContents& contents, const ViewState& state,
                                         const theme::Fonts& fonts) {
  Clicks clicks;
  const LiveStatus* const live = contents.live;
  if (live != nullptr) {
    phase_line(*live, fonts);
    show_coverage(live->coverage, fonts);
  } else {
    ImGui::PushFont(fonts.large);
    text(theme::kText, "Light field");
    ImGui::PopFont();
    for (const auto& [name, value] : contents.facts) row(name, value);
  }
  show_layers(state, live != nullptr, clicks);
  if (live != nullptr) {
    gap(0.3f);
    live_buttons(*live, clicks);
    quality_curve(*live);
    frame_counts(*live);
  }
  if (live != nullptr) stage_times(*live, contents.drawing_ms);
  gap(0.5f);
  text(theme::kQuiet, "H  all keys");
  return clicks;
}

void show_patch_card(const PatchNews& patch, const ImVec2& lower_right) {
  const float em = ImGui::GetFontSize();
  ImGui::SetNextWindowPos(lower_right, ImGuiCond_Always, {1, 1});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.5f * em);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2{em, 0.8f * em});
  ImGui::Begin("patch", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoSavedSettings);
  text(theme::kQuiet, fmt::format("Patch {}", patch.patch_idx));
  if (patch.samples) {
    plot_directions(patch.seen, patch.reachable, patch.present_uv, 8.5f * em);
    text(theme::kText, fmt::format("{} samples", *patch.samples));
    text(theme::kAccent, "seen from");
    ImGui::SameLine();
    text(theme::kAlarm, "still empty");
  } else {
    plot_radiance(patch.colour_at, patch.present_uv, 10 * em);
  }
  ImGui::End();
  ImGui::PopStyleVar(2);
}

void show_help(bool live) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5f * display.x, 0.5f * display.y}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.5f * ImGui::GetFontSize());
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding,
                      ImVec2{1.8f * ImGui::GetFontSize(), 1.4f * ImGui::GetFontSize()});
  ImGui::Begin("Keys", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoSavedSettings);
  const auto line = [](const char* what, const char* meaning) {
    text(theme::kAccent, what);
    ImGui::SameLine(7.5f * ImGui::GetFontSize());
    text(theme::kText, meaning);
  };
  line("Left drag", "Turn round the object");
  line("Right drag", "Move (or middle)");
  line("Wheel", "Nearer and farther");
  gap(0.4f);
  for (const KeyBinding& binding : key_bindings()) {
    if (binding.key_text == nullptr || (binding.live_only && !live)) continue;
    line(binding.key_text, binding.meaning);
  }
  ImGui::End();
  ImGui::PopStyleVar(2);
}

}  // namespace sheen::app
