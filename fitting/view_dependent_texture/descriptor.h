// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/descriptor.h"

namespace sheen::fitting::view_dependent_texture {

extern const Descriptor kDescriptor;

}  // namespace sheen::fitting::view_dependent_texture
