// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/descriptor.h"

namespace sheen::fitting::billboard {

extern const Descriptor kDescriptor;

}  // namespace sheen::fitting::billboard
