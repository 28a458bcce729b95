// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/descriptor.h"

namespace sheen::fitting::depth_quads {

extern const Descriptor kDescriptor;

}  // namespace sheen::fitting::depth_quads
