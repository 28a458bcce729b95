// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace sheen::exporters::viewer {

/// A file of the web viewer as built from web/viewer: "page.html", "viewer.css", "viewer.js". Lives
/// as long as the program.
std::string_view web_text(std::string_view name);

}  // namespace sheen::exporters::viewer
