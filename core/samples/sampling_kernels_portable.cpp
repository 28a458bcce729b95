// SPDX-License-Identifier: MIT
#define SHEEN_LANES portable
#include "core/samples/sampling_loops.h"

namespace sheen::core {

SamplingKernels portable_sampling_kernels();
SamplingKernels portable_sampling_kernels() {
  return {"portable", portable::project, portable::read};
}

}  // namespace sheen::core
