// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "fitting/light_field.h"
#include "fitting/model_file/model_part.h"

#include <memory>

namespace sheen::fitting::multi_eigenspace {

/// The mean colours as representation `mean` keeps them, and: parameters pictureSize, switching
/// ("cross-fade", "hard"), views, spaces, entries; arrays, left out where there is no view: frame,
/// doubles middle [3], radius, up [3]; directions, doubles [view][3]; owners, unsigned 32-bit
/// [view]; dimensions, unsigned 32-bit [space]; means, unsigned 8-bit [space][row][column][b, g, r,
/// coverage]; entries, unsigned 32-bit [entry][view, space], ascending; and, left out where no
/// space has an eigenimage: images, signed 8-bit [space][eigenimage][row][column][4]; steps, floats
/// [space][eigenimage]; viewCoefficients, signed 16-bit [entry][eigenimage].
ModelPart encode_model(const LightField& light_field);
std::unique_ptr<const LightField> decode_model(const ModelPart& part, const core::Mesh& mesh);

}  // namespace sheen::fitting::multi_eigenspace
