// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/neighbours.h"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace sheen::fitting {

/// Colours for patches that no view saw: ring by ring outwards from the seen ones, each the mean of
/// its neighbours in earlier rings. Parts of the surface without any seen patch get the mean of all
/// seen ones, or mid grey when there are none. `colours` holds one sRGB colour per patch; entries
/// whose `observed` flag is 0 are replaced.
void fill_unseen(const core::VertexNeighbours& neighbours,
                 const std::vector<std::uint8_t>& observed, std::vector<Eigen::Vector3f>& colours);

}  // namespace sheen::fitting
