// SPDX-License-Identifier: MIT
#pragma once

#include "exporters/format.h"

namespace sheen::exporters::usd {

/// Universal Scene Description as text: the mesh with displayColor, y up, metres.
extern const Format kFormat;

}  // namespace sheen::exporters::usd
