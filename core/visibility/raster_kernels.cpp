// SPDX-License-Identifier: MIT
#include "core/visibility/raster_kernels.h"

namespace sheen::core {

// One file each: raster_kernels_*.cpp.
RasterKernels portable_raster_kernels();
#ifdef SHEEN_HAS_AVX2_KERNELS
RasterKernels avx2_raster_kernels();
#endif

const std::vector<RasterKernels>& raster_kernel_sets() {
  static const auto sets = [] {
    std::vector<RasterKernels> of_this_processor;
#ifdef SHEEN_HAS_AVX2_KERNELS
    if (__builtin_cpu_supports("avx2")) of_this_processor.push_back(avx2_raster_kernels());
#endif
    of_this_processor.push_back(portable_raster_kernels());
    return of_this_processor;
  }();
  return sets;
}

}  // namespace sheen::core
