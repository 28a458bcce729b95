// SPDX-License-Identifier: MIT
// Compiled for AVX2 and F16C, see fitting/CMakeLists.txt; called only where the processor has them.
#define SHEEN_LANES avx2
#include "fitting/iwls/quad_patch_fit.h"

namespace sheen::fitting::iwls {

QuadKernelSet<float> avx2_quad_kernels() {
  return avx2::quad_kernels<float>("avx2");
}

QuadKernelSet<double> avx2_exact_quad_kernels() {
  return avx2::quad_kernels<double>("avx2");
}

EvaluateKernels avx2_evaluate_kernels() {
  return avx2::evaluate_kernels();
}

}  // namespace sheen::fitting::iwls
