// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace sheen::app {

/// A page that shows a batch's summary and needs no network; it links to the steps' files beside
/// it.
std::string batch_page(const nlohmann::ordered_json& summary);

}  // namespace sheen::app
