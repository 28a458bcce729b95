// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/descriptor.h"

namespace sheen::fitting::eigen_texture {

extern const Descriptor kDescriptor;

}  // namespace sheen::fitting::eigen_texture
