// SPDX-License-Identifier: MIT
#include "core/visibility/raster_kernels.h"

#include "core/numerics/kernel_sets.h"

namespace sheen::core {

// One file each: raster_kernels_*.cpp.
RasterKernels portable_raster_kernels();
#ifdef SHEEN_HAS_AVX2_KERNELS
RasterKernels avx2_raster_kernels();
#else
constexpr RasterKernels (*avx2_raster_kernels)() = nullptr;
#endif

const std::vector<RasterKernels>& raster_kernel_sets() {
  static const auto sets = kernel_sets(portable_raster_kernels, avx2_raster_kernels);
  return sets;
}

}  // namespace sheen::core
