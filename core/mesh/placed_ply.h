// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"

#include <filesystem>

namespace sheen::core {

/// As write_ply, but where the mesh's file has it: with its offset added back, in double precision
/// where there is one.
void write_placed_ply(const std::filesystem::path& path, const Mesh& mesh);

}  // namespace sheen::core
