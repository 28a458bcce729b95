// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "fitting/option_table.h"

#include <Eigen/Geometry>

#include <span>
#include <string_view>

namespace sheen::pipeline {

/// What a pixel covers on a surface around `centre` (metres), in the middle one of some views of a
/// camera with this focal length (pixels). At least one view.
double pixel_footprint_m(std::span<const Eigen::Isometry3d> camera_from_object,
                         const Eigen::Vector3d& centre, double focal_px);

/// Whether the representation has texels whose side (option "texel-mm") nobody has chosen.
bool asks_texel_size(std::string_view representation, const fitting::OptionValues& values);

/// Whether texels of this size lie clearly more densely than the vertices.
bool are_finer_than_vertices(double texel_m, const core::Mesh& mesh);

/// Texels of the surface for each of its vertices.
double texels_per_vertex(double texel_m, const core::Mesh& mesh);

/// Chooses it.
void set_texel_size(double texel_m, fitting::OptionValues& values);

}  // namespace sheen::pipeline
