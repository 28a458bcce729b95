// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/coloured_ply.h"
#include "fitting/model_file/model_file.h"

#include <vector>

namespace sheen::exporters {

/// How far each vertex can be trusted; empty where the model does not say. The mean is that of
/// fitting::confidence_cells over the cells whose centre is a direction.
std::vector<core::VertexConfidence> vertex_confidence(const fitting::Model& model);

}  // namespace sheen::exporters
