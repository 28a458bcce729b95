// SPDX-License-Identifier: MIT
#pragma once

#include "exporters/format.h"

namespace sheen::exporters::viewer {

/// One page that shows the light field in any browser (docs/exports.md, "Web viewer").
extern const Format kFormat;

}  // namespace sheen::exporters::viewer
