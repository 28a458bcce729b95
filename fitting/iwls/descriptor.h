// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/descriptor.h"

namespace sheen::fitting::iwls {

extern const Descriptor kDescriptor;

}  // namespace sheen::fitting::iwls
