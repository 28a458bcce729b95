// SPDX-License-Identifier: MIT
#pragma once

#include "evaluation/report/table.h"
#include "evaluation/scene/scene_study.h"

#include <span>
#include <string>

namespace sheen::evaluation {

/// Every row with every figure.
Table all_rows(std::span<const SceneRow> rows);
Table all_rows(std::span<const BusyRow> rows);

/// Methods down, numbers of samples across: PSNR on the held-out walk and on scattered views.
Table psnr_against_samples(std::span<const SceneRow> rows, const std::string& environment);

/// Methods down: numbers per patch by material, error of Lambert points, time, cost of outliers;
/// with 96 samples.
Table numbers_by_material(std::span<const SceneRow> rows, const std::string& environment);

/// RMS and numbers under the busy environment.
Table busy_table(std::span<const BusyRow> rows);

/// What the parsimonious method promises, measured (studio, 96 samples).
Table scene_targets(std::span<const SceneRow> rows, const std::string& method);

}  // namespace sheen::evaluation
