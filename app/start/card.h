// SPDX-License-Identifier: MIT
#pragma once

#include "app/preview/theme.h"
#include "app/start/start_commands.h"

#include <imgui.h>

#include <string>

namespace sheen::app {

/// A step of the start window: begins its window, to be ended by ImGui::End.
void begin_card(const char* name, const ImVec2& corner, const ImVec2& size, float scale);

void step_title(const char* number, const char* words, const theme::Fonts& fonts);

/// Where the parts at a card's foot begin, y in its window: fields to fill, the command, its
/// button.
struct CardFoot {
  float fields, command, button;
};
CardFoot card_foot(const Arguments& arguments, int fields);

/// From the cursor to a place below.
float room_above(float y);

/// The text, its end left out where it is wider than this.
std::string fitted(std::string words, float width);

}  // namespace sheen::app
