// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/guidance/direction_cells.h"

#include <Eigen/Core>
#include <imgui.h>

#include <functional>
#include <optional>

namespace sheen::app {

/// Disc of a patch's directions: cells it was seen from, cells still empty that a camera could
/// reach, and where the present view falls.
void plot_directions(fitting::guidance::DirectionCells seen,
                     fitting::guidance::DirectionCells reachable,
                     const std::optional<Eigen::Vector2f>& present, float diameter);

/// The same disc painted with the patch's radiance, `colour_at(uv)` in sRGB.
void plot_radiance(const std::function<Eigen::Vector3f(const Eigen::Vector2f&)>& colour_at,
                   const std::optional<Eigen::Vector2f>& present, float diameter);

}  // namespace sheen::app
