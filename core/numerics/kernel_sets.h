// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace sheen::core {

/// Whether this processor runs what was compiled for AVX2 and half floats.
inline bool processor_has_avx2() {
#ifdef SHEEN_HAS_AVX2_KERNELS
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("f16c");
#else
  return false;
#endif
}

/// Inner loops that are compiled once for every processor and once for AVX2: those that this one
/// can run, the fastest first. Where the build has no AVX2 `avx2` is null.
template <typename Kernels>
std::vector<Kernels> kernel_sets(Kernels (*portable)(), Kernels (*avx2)()) {
  std::vector<Kernels> sets;
  if (avx2 != nullptr && processor_has_avx2()) sets.push_back(avx2());
  sets.push_back(portable());
  return sets;
}

}  // namespace sheen::core
