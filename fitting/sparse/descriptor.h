// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/descriptor.h"

namespace sheen::fitting::sparse {

extern const Descriptor kDescriptor;

}  // namespace sheen::fitting::sparse
