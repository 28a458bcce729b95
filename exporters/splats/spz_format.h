// SPDX-License-Identifier: MIT
#pragma once

#include "exporters/format.h"

namespace sheen::exporters {

/// Niantic's compressed splats, version 2, which every reader takes: y up, harmonics of 8 bits.
extern const Format kSpzFormat;

}  // namespace sheen::exporters
