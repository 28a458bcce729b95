// SPDX-License-Identifier: MIT
#pragma once

#include "evaluation/comparison/advice.h"

#include <nlohmann/json.hpp>

namespace sheen::evaluation {

/// One line per candidate and session, first line the names of the columns (RFC 4180).
std::string to_csv(const Comparison& comparison);

/// A table per session for a terminal, then who was left out.
std::string to_text(const Comparison& comparison);

/// {"sessions", "results", "averages", "left_out", "advice"}
nlohmann::ordered_json to_json(const Comparison& comparison, const std::optional<Advice>& advice);

}  // namespace sheen::evaluation
