// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/descriptor.h"

namespace sheen::fitting::multi_eigenspace {

extern const Descriptor kDescriptor;

}  // namespace sheen::fitting::multi_eigenspace
