// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace sheen::app {

/// A part of the page of a batch, embedded by the build: batch.html, batch.css, batch.js. Lives as
/// long as the program.
std::string_view batch_page_text(std::string_view name);

}  // namespace sheen::app
