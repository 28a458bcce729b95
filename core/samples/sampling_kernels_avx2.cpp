// SPDX-License-Identifier: MIT
// Compiled for AVX2, see core/CMakeLists.txt; called only where the processor has it.
#define SHEEN_LANES avx2
#include "core/samples/sampling_loops.h"

namespace sheen::core {

SamplingKernels avx2_sampling_kernels();
SamplingKernels avx2_sampling_kernels() {
  return {"avx2", avx2::project, avx2::read};
}

}  // namespace sheen::core
