// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace sheen::evaluation {

/// The script that draws the study's charts, embedded by the build: charts.py.
std::string_view billboard_charts(std::string_view name);

}  // namespace sheen::evaluation
