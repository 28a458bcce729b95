// SPDX-License-Identifier: MIT
#pragma once

#include "app/batch/failure.h"
#include "app/batch/session_work.h"

#include <nlohmann/json.hpp>

#include <span>
#include <string>

namespace sheen::app {

/// What came of a batch, from the reports that the steps left: for every session its state, its
/// figures, and what another walk should look at. {"wanted", "counts", "sessions": [{"name",
/// "state", "frames", "posed", ..., "again": ["..."], "sectors": [...]}]}; docs/batch.md.
nlohmann::ordered_json summarise_batch(const Jobs& jobs, std::span<const SessionWork> sessions,
                                       const Failures& failures);

/// A table, then the sessions that want another walk or failed, with the reasons.
std::string batch_text(const nlohmann::ordered_json& summary);

}  // namespace sheen::app
