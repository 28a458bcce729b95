// SPDX-License-Identifier: MIT
#include "render/eigen_texture/blend_kernels.h"

#include <algorithm>
#include <cmath>

namespace sheen::render::eigen_texture {

// One file for each kind of processor: blend_*.cpp.
BlendKernel portable_kernel();
#ifdef SHEEN_X86_64
BlendKernel multiply_high_kernel();
BlendKernel multiply_add_kernel();
BlendKernel tile_kernel();
#endif

const std::vector<BlendKernel>& blend_kernels() {
  static const auto all = [] {
    std::vector<BlendKernel> kernels;
#ifdef SHEEN_X86_64
    if (__builtin_cpu_supports("avx2")) kernels.push_back(tile_kernel());
    if (__builtin_cpu_supports("ssse3")) {
      kernels.push_back(multiply_high_kernel());
      kernels.push_back(multiply_add_kernel());
    }
#endif
    kernels.push_back(portable_kernel());
    return kernels;
  }();
  return all;
}

std::int16_t fixed_coefficient(float coefficient) {
  constexpr float most = 32767.0f;
  return static_cast<std::int16_t>(
      std::lround(std::clamp(coefficient * float{1 << kCoefficientBits}, -most, most)));
}

}  // namespace sheen::render::eigen_texture
