// SPDX-License-Identifier: MIT
#pragma once

#include "exporters/format.h"

namespace sheen::exporters::obj {

/// Wavefront OBJ with a material file and a texture of mean radiance (PNG), y up.
extern const Format kFormat;

}  // namespace sheen::exporters::obj
