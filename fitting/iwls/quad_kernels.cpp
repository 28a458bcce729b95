// SPDX-License-Identifier: MIT
#include "fitting/iwls/quad_kernels.h"

namespace sheen::fitting::iwls {

// One file each: quad_kernels_*.cpp.
void fill_portable_kernels(QuadKernelSet<float>& set);
void fill_portable_kernels(QuadKernelSet<double>& set);
EvaluateKernels portable_evaluate_kernels();
#ifdef SHEEN_HAS_AVX2_KERNELS
void fill_avx2_kernels(QuadKernelSet<float>& set);
void fill_avx2_kernels(QuadKernelSet<double>& set);
EvaluateKernels avx2_evaluate_kernels();
#endif

namespace {

bool has_avx2() {
#ifdef SHEEN_HAS_AVX2_KERNELS
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("f16c");
#else
  return false;
#endif
}

template <typename Real>
std::vector<QuadKernelSet<Real>> sets_of_this_processor() {
  std::vector<QuadKernelSet<Real>> sets;
#ifdef SHEEN_HAS_AVX2_KERNELS
  if (has_avx2()) {
    fill_avx2_kernels(sets.emplace_back(QuadKernelSet<Real>{"avx2", {}, {}, {}}));
  }
#endif
  fill_portable_kernels(sets.emplace_back(QuadKernelSet<Real>{"portable", {}, {}, {}}));
  return sets;
}

EvaluateKernels best_evaluate_kernels() {
#ifdef SHEEN_HAS_AVX2_KERNELS
  if (has_avx2()) return avx2_evaluate_kernels();
#endif
  return portable_evaluate_kernels();
}

}  // namespace

const EvaluateKernels& evaluate_kernels() {
  static const EvaluateKernels kernels = best_evaluate_kernels();
  return kernels;
}

template <>
const std::vector<QuadKernelSet<float>>& quad_kernel_sets() {
  static const auto sets = sets_of_this_processor<float>();
  return sets;
}

template <>
const std::vector<QuadKernelSet<double>>& quad_kernel_sets() {
  static const auto sets = sets_of_this_processor<double>();
  return sets;
}

}  // namespace sheen::fitting::iwls
