// SPDX-License-Identifier: MIT
#include "core/samples/sampling_kernels.h"

#include <bit>

namespace sheen::core {

static_assert(std::endian::native == std::endian::little, "pixels are read as words");

// One file each: sampling_kernels_*.cpp.
SamplingKernels portable_sampling_kernels();
#ifdef SHEEN_HAS_AVX2_KERNELS
SamplingKernels avx2_sampling_kernels();
#endif

const std::vector<SamplingKernels>& sampling_kernel_sets() {
  static const auto sets = [] {
    std::vector<SamplingKernels> of_this_processor;
#ifdef SHEEN_HAS_AVX2_KERNELS
    if (__builtin_cpu_supports("avx2")) of_this_processor.push_back(avx2_sampling_kernels());
#endif
    of_this_processor.push_back(portable_sampling_kernels());
    return of_this_processor;
  }();
  return sets;
}

}  // namespace sheen::core
