// SPDX-License-Identifier: MIT
#include "fitting/iwls/quad_patch_fit.h"

namespace sheen::fitting::iwls {

void fill_portable_kernels(QuadKernelSet<float>& set) {
  portable::fill_kernels(set);
}

void fill_portable_kernels(QuadKernelSet<double>& set) {
  portable::fill_kernels(set);
}

EvaluateKernels portable_evaluate_kernels() {
  return portable::evaluate_kernels();
}

}  // namespace sheen::fitting::iwls
