// SPDX-License-Identifier: MIT
// Compiled for AVX2, see core/CMakeLists.txt; called only where the processor has it.
#define SHEEN_LANES avx2
#include "core/visibility/raster_loops.h"

namespace sheen::core {

RasterKernels avx2_raster_kernels();
RasterKernels avx2_raster_kernels() {
  return {"avx2", avx2::draw};
}

}  // namespace sheen::core
