// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/descriptor.h"

namespace sheen::fitting::nearest_views {

extern const Descriptor kDescriptor;

}  // namespace sheen::fitting::nearest_views
