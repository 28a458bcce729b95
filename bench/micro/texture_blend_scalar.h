// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

namespace sheen::bench {

/// render/eigen_texture/blend_loops.h, compiled without vectors: what SIMD is measured against.
void blend_without_vectors(const std::int8_t* basis, std::size_t bases, std::size_t texels,
                           const std::int16_t* coefficients, std::int16_t* sums);

}  // namespace sheen::bench
