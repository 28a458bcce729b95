// SPDX-License-Identifier: MIT
#include "fitting/iwls/quad_patch_fit.h"

namespace sheen::fitting::iwls {

QuadKernelSet<float> portable_quad_kernels() {
  return portable::quad_kernels<float>("portable");
}

QuadKernelSet<double> portable_exact_quad_kernels() {
  return portable::quad_kernels<double>("portable");
}

EvaluateKernels portable_evaluate_kernels() {
  return portable::evaluate_kernels();
}

}  // namespace sheen::fitting::iwls
