// SPDX-License-Identifier: MIT
#include "core/samples/sampling_kernels.h"

#include "core/numerics/kernel_sets.h"

#include <bit>

namespace sheen::core {

static_assert(std::endian::native == std::endian::little, "pixels are read as words");

// One file each: sampling_kernels_*.cpp.
SamplingKernels portable_sampling_kernels();
#ifdef SHEEN_HAS_AVX2_KERNELS
SamplingKernels avx2_sampling_kernels();
#else
constexpr SamplingKernels (*avx2_sampling_kernels)() = nullptr;
#endif

const std::vector<SamplingKernels>& sampling_kernel_sets() {
  static const auto sets = kernel_sets(portable_sampling_kernels, avx2_sampling_kernels);
  return sets;
}

}  // namespace sheen::core
