// SPDX-License-Identifier: MIT
#pragma once

#include "evaluation/report/table.h"
#include "evaluation/stability/stability_suite.h"

#include <span>
#include <vector>

namespace sheen::evaluation {

/// Every row with every figure.
Table all_rows(std::span<const StabilityRow> rows);

/// One table for each view set: methods down, numbers of samples across, RMS.
std::vector<Table> error_against_samples(std::span<const StabilityRow> rows);

/// Methods down, settings of one view set across, with 64 samples: RMS.
Table error_against_settings(std::span<const StabilityRow> rows, ViewSet views);

/// Methods down, view sets across, with 64 samples: worst error before clamping (95th percentile
/// over points), and the RMS inside the sector that `gap` leaves out.
Table extrapolation(std::span<const StabilityRow> rows);

/// How much more samples can hurt: for each method and view set the largest increase of the RMS
/// over the best with fewer samples, in percent, and where it happens. Base settings and all
/// others.
Table monotonicity(std::span<const StabilityRow> rows);

/// The same for one method, one line for each setting.
Table monotonicity_of(std::span<const StabilityRow> rows, const std::string& method);

/// What the parsimonious method promises, measured: all glossy classes on handheld arcs with 64
/// samples, worst values, more samples.
Table stability_targets(std::span<const StabilityRow> rows, const std::string& method);

}  // namespace sheen::evaluation
