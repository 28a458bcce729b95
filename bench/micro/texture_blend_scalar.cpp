// SPDX-License-Identifier: MIT
#include "bench/micro/texture_blend_scalar.h"

#include "render/eigen_texture/blend_loops.h"

namespace sheen::bench {

void blend_without_vectors(const std::int8_t* basis, std::size_t bases, std::size_t texels,
                           const std::int16_t* coefficients, std::int16_t* sums) {
  render::eigen_texture::blend_plainly(basis, bases, texels, coefficients, sums);
}

}  // namespace sheen::bench
