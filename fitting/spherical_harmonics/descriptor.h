// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/descriptor.h"

namespace sheen::fitting::spherical_harmonics {

extern const Descriptor kDescriptor;

}  // namespace sheen::fitting::spherical_harmonics
