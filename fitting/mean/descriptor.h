// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/descriptor.h"

namespace sheen::fitting::mean {

extern const Descriptor kDescriptor;

}  // namespace sheen::fitting::mean
