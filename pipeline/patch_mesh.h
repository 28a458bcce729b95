// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "pipeline/session_parts.h"

#include <optional>

namespace sheen::pipeline {

/// Size of a pixel on the object, metres: distance over focal length, median over some posed frames
/// among the first ninety. Nothing when none of those gets a pose.
std::optional<double> pixel_footprint_m(const capture::Session& session, const core::Mesh& mesh,
                                        capture::PoseEstimator& poses);

/// A mesh whose vertices stand as close as the images resolve: no edge longer than `spacing_px`
/// pixels.
core::Mesh texel_mesh(const core::Mesh& mesh, double pixel_footprint_m, double spacing_px);

}  // namespace sheen::pipeline
