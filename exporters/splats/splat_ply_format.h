// SPDX-License-Identifier: MIT
#pragma once

#include "exporters/format.h"

namespace sheen::exporters {

/// The PLY of the reference implementation of 3D Gaussian Splatting, in the axes of its poses: y
/// down.
extern const Format kSplatPlyFormat;

}  // namespace sheen::exporters
