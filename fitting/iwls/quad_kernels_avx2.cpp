// SPDX-License-Identifier: MIT
// Compiled for AVX2 and F16C, see fitting/CMakeLists.txt; called only where the processor has them.
#define SHEEN_LANES avx2
#include "fitting/iwls/quad_patch_fit.h"

namespace sheen::fitting::iwls {

void fill_avx2_kernels(QuadKernelSet<float>& set) {
  avx2::fill_kernels(set);
}

void fill_avx2_kernels(QuadKernelSet<double>& set) {
  avx2::fill_kernels(set);
}

EvaluateKernels avx2_evaluate_kernels() {
  return avx2::evaluate_kernels();
}

}  // namespace sheen::fitting::iwls
