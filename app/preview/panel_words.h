// SPDX-License-Identifier: MIT
#pragma once

#include "app/preview/theme.h"

#include <imgui.h>

#include <string>

namespace sheen::app {

/// Words in the present ImGui window.
void text(const ImVec4& colour, const std::string& words);
/// The same over as many lines as they take.
void wrapped(const ImVec4& colour, const std::string& words);
/// Room between lines, in heights of the font.
void gap(float lines);
/// Name at the left, value at the right.
void row(const std::string& name, const std::string& value, const ImVec4& colour = theme::kText);
/// A line of words with a rule below.
void heading(const std::string& words);

}  // namespace sheen::app
