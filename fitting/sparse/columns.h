// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace sheen::fitting::sparse {

/// Rows that a column has room for: the most samples a patch may keep.
inline constexpr std::size_t kColumnRows = 128;
/// Rows are worked on in groups of this many.
inline constexpr std::size_t kRowGroup = 8;

/// One number for each of up to kColumnRows samples.
struct alignas(64) Column {
  float row[kColumnRows];
};

/// Rows rounded up to whole groups. What follows works on whole groups: callers keep the rows
/// behind the last sample so that they add nothing.
constexpr std::size_t padded(std::size_t rows) {
  return (rows + kRowGroup - 1) / kRowGroup * kRowGroup;
}

/// The inner loops of sparse fits. Compiled for AVX2 too where the processor has it, with the same
/// results to the bit; `rows` is a multiple of kRowGroup.
namespace columns {

/// out = weight * theta(|(u, v) - (center_u, center_v)| / support), theta Wendland's function.
void wendland(const Column& u, const Column& v, const Column& weight, std::size_t rows,
              float center_u, float center_v, float support, Column& out);

/// Sum over the rows of weight * theta(|(u, v) - (center_u, center_v)| / support).
float wendland_sum(const Column& u, const Column& v, const Column& weight, std::size_t rows,
                   float center_u, float center_v, float support);

/// out[i] = sum_j theta(|x_i - x_j| / reach). Rows behind the last sample must lie further than
/// `reach` from all samples.
void kernel_density(const Column& u, const Column& v, std::size_t rows, float reach, Column& out);

float dot(const Column& a, const Column& b, std::size_t rows);

/// out[k] = columns[k] . b, k < count.
void dots(const Column* columns, std::size_t count, const Column& b, std::size_t rows, float* out);

/// out -= sum_k factor[k] * columns[k].
void subtract(const Column* columns, std::size_t count, const float* factor, std::size_t rows,
              Column& out);

/// out *= factor.
void scale(const Column& factor, std::size_t rows, Column& out);

/// out[i] = sum_k columns[k][i]^2.
void squared_lengths(const Column* columns, std::size_t count, std::size_t rows, Column& out);

/// The first k < count with the greatest (r_k^2 + g_k^2 + b_k^2) / remainder_k among those whose
/// remainder is greater than `least`; `count` where none is greater than zero. `count` is a
/// multiple of kRowGroup, and the numbers are aligned like columns.
std::size_t best_gain(const float* r, const float* g, const float* b, const float* remainder,
                      std::size_t count, float least);

}  // namespace columns
}  // namespace sheen::fitting::sparse
