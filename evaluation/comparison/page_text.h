// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace sheen::evaluation {

/// A part of the comparison's page or the script that draws its charts, embedded by the build:
/// page.html, page.css, page.js, charts.py. Lives as long as the program.
std::string_view page_text(std::string_view name);

}  // namespace sheen::evaluation
