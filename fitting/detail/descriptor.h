// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/descriptor.h"

namespace sheen::fitting::detail {

extern const Descriptor kDescriptor;

}  // namespace sheen::fitting::detail
