// SPDX-License-Identifier: MIT
#pragma once

#include "exporters/format.h"

namespace sheen::exporters::ply {

/// The mesh with normals and mean colours, binary, in the object's own axes.
extern const Format kFormat;

}  // namespace sheen::exporters::ply
