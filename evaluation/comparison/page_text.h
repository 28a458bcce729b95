// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace sheen::evaluation {

/// A part of the comparison's page or the script that draws its charts, embedded by the build:
/// comparison/page.html, comparison/charts.py and so on. Lives as long as the program.
std::string_view page_text(std::string_view name);

}  // namespace sheen::evaluation
