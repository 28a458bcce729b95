// SPDX-License-Identifier: MIT
#include "fitting/iwls/quad_kernels.h"

#include "core/numerics/kernel_sets.h"

namespace sheen::fitting::iwls {

// One file each: quad_kernels_*.cpp.
QuadKernelSet<float> portable_quad_kernels();
QuadKernelSet<double> portable_exact_quad_kernels();
EvaluateKernels portable_evaluate_kernels();
#ifdef SHEEN_HAS_AVX2_KERNELS
QuadKernelSet<float> avx2_quad_kernels();
QuadKernelSet<double> avx2_exact_quad_kernels();
EvaluateKernels avx2_evaluate_kernels();
#else
constexpr QuadKernelSet<float> (*avx2_quad_kernels)() = nullptr;
constexpr QuadKernelSet<double> (*avx2_exact_quad_kernels)() = nullptr;
constexpr EvaluateKernels (*avx2_evaluate_kernels)() = nullptr;
#endif

const EvaluateKernels& evaluate_kernels() {
  static const auto sets = core::kernel_sets(portable_evaluate_kernels, avx2_evaluate_kernels);
  return sets.front();
}

template <>
const std::vector<QuadKernelSet<float>>& quad_kernel_sets() {
  static const auto sets = core::kernel_sets(portable_quad_kernels, avx2_quad_kernels);
  return sets;
}

template <>
const std::vector<QuadKernelSet<double>>& quad_kernel_sets() {
  static const auto sets = core::kernel_sets(portable_exact_quad_kernels, avx2_exact_quad_kernels);
  return sets;
}

}  // namespace sheen::fitting::iwls
